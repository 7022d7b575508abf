#include "contact/barrier.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "base/error.h"
#include "base/parallel.h"
#include "contact/contact_reach.h"
#include "contact/stencil_search.h"
#include "contact/step_bound.h"
#include "math/vectors.h"

namespace aspic {
namespace {

std::vector<double> sizes_of(const ContactMesh& mesh) {
  std::vector<double> sizes;
  for (const ContactPart& part : mesh.parts) {
    Box box;
    for (int i = 0; i < part.point_count; ++i) box.add(mesh.rest[part.first_point + i]);
    sizes.push_back(part.point_count > 0 ? norm(box.upper - box.lower) : 0);
  }
  return sizes;
}

// Returns the point of a body that is closest to a sphere or a capsule.
ContactPoint foot_of(const ContactStencil& stencil, const ContactMesh& mesh, std::span<const Vec3d> x) {
  ContactPoint foot{.gap = stencil.gap(), .pressure = 0};
  foot.pressure = -stencil.weight / stencil.area * stencil.b().first;
  double most = 0, sum = 0;
  for (int k = 0; k < stencil.distance.count; ++k) {
    const int p = stencil.point[stencil.distance.point[k]];
    const double weight = std::abs(stencil.distance.c[k]);
    if (mesh.row[p] < 0) continue;
    foot.position = foot.position + weight * x[p];
    sum += weight;
    if (weight > most) most = weight, foot.row = mesh.row[p];
  }
  if (sum > 1.5) foot.position = (1 / sum) * foot.position;  // of two bodies
  return foot;
}

double obstacle_end(const Energy::Context& context) { return context.obstacle_end.value_or(context.time); }

}  // namespace

struct Barrier::Impl {
  Impl(ContactMesh m, const ContactOptions& options)
      : mesh(std::move(m)), sizes(sizes_of(mesh)), laws(bounded_laws(options)), search(mesh, laws) {}

  ContactLaws bounded_laws(const ContactOptions& options) const {
    ContactLaws bounded(mesh, options);
    if (options.reach > 0) return bounded;
    std::vector<Vec3d> start = obstacles(0);
    for (int i = 0; i < mesh.point_count() && !options.start.empty(); ++i)
      if (mesh.row[i] >= 0) start[i] = point(options.start, mesh.row[i]);
    bound_reaches(mesh, start, options.overlapping, bounded);
    return bounded;
  }

  // Returns positions of all points; only those of obstacles are set.
  std::vector<Vec3d> obstacles(double time) const {
    std::vector<Vec3d> p = mesh.rest;
    for (const ContactPart& part : mesh.parts) {
      if (!part.motion) continue;
      const size_t count = std::max(part.point_count, 1);  // a plane has its origin
      part.motion(time, std::span(mesh.rest).subspan(part.first_point, count),
                  std::span(p).subspan(part.first_point, count));
      for (const Vec3d& y : std::span(p).subspan(part.first_point, count))
        if (!std::isfinite(y[0] + y[1] + y[2]))
          throw InvalidInput("obstacle '" + part.name + "' has no finite position at t = " + std::to_string(time) +
                             " s; correct its motion");
    }
    return p;
  }

  // Returns positions of all points: variables from x, obstacles at the given time.
  std::vector<Vec3d> points(Positions x, double time) const {
    std::vector<Vec3d> p;
    {
      const std::scoped_lock lock(mutex);
      if (placed.empty() || time != placed_at) placed = obstacles(time), placed_at = time;
      p = placed;
    }
    for (int i = 0; i < mesh.point_count(); ++i)
      if (mesh.row[i] >= 0) p[i] = point(x, mesh.row[i]);
    return p;
  }

  // Returns the displacements of obstacles between two times; zero for other points.
  std::vector<Vec3d> obstacle_moves(double from, double to) const {
    std::vector<Vec3d> u(mesh.rest.size());
    if (from == to || !has_motion) return u;
    const std::vector<Vec3d> start = obstacles(from), end = obstacles(to);
    for (size_t i = 0; i < u.size(); ++i) u[i] = end[i] - start[i];
    return u;
  }
  // Adds the change of the gradient if obstacles move by u, to first order.
  void add_obstacle_pull(std::span<const Vec3d> p, std::span<const Vec3d> u, double scale, std::span<double> g) const;
  // Returns the displacements of all points if obstacles move between two times.
  std::vector<Vec3d> displacements(std::span<const double> d, double from, double to) const {
    std::vector<Vec3d> u = obstacle_moves(from, to);
    for (int i = 0; i < mesh.point_count(); ++i)
      if (mesh.row[i] >= 0) u[i] = point(d, mesh.row[i]);
    return u;
  }
  std::vector<Vec3d> displacements(std::span<const double> d, const Context& context) const {
    return displacements(d, context.time, obstacle_end(context));
  }

  ContactMesh mesh;
  std::vector<double> sizes;  // sizes of the parts at rest [m]
  ContactLaws laws;
  StencilSearch search;
  bool has_motion =
      std::any_of(mesh.parts.begin(), mesh.parts.end(), [](const ContactPart& part) { return part.motion != nullptr; });
  mutable std::mutex mutex;
  mutable std::vector<Vec3d> placed;  // last result of obstacles()
  mutable double placed_at = 0;
};

void Barrier::Impl::add_obstacle_pull(std::span<const Vec3d> p, std::span<const Vec3d> u, double scale,
                                      std::span<double> g) const {
  for (const ContactStencil& stencil : *search.at(p)) {
    std::array<Vec3d, 4> moved = {};
    bool moves = false;
    for (int k = 0; k < 4; ++k)
      if (const int own = stencil.point[k]; own >= 0 && mesh.row[own] < 0) moved[k] = u[own];
    for (const ContactPlane& plane : mesh.planes)
      if (plane.part == stencil.parts[1]) moved[0] = -1.0 * u[plane.point];  // relative motion
    for (const Vec3d& m : moved) moves = moves || squared_norm(m) > 0;
    if (!moves) continue;
    const DistanceHessian H = stencil.hessian(p, Definiteness::exact);
    for (int i = 0; i < 4; ++i) {
      const int own = stencil.point[i];
      if (own < 0 || mesh.row[own] < 0) continue;
      Vec3d change{};
      for (int k = 0; k < 4; ++k) change = change + (i >= k ? H(i, k) : transpose(H(k, i))) * moved[k];
      add_vec(scale * change, mesh.row[own], g);
    }
  }
}

Barrier::Barrier(ContactMesh mesh, const ContactOptions& options)
    : impl_(std::make_unique<Impl>(std::move(mesh), options)) {}
Barrier::~Barrier() = default;

const ContactMesh& Barrier::mesh() const { return impl_->mesh; }
const ContactLaws& Barrier::laws() const { return impl_->laws; }
int Barrier::self_touching_point() const { return impl_->search.self_touching_point(); }

std::vector<Touch> Barrier::touches(Positions x, double time) const {
  return aspic::touches(impl_->mesh, impl_->laws, impl_->search, impl_->points(x, time));
}

bool Barrier::has_moving_obstacle() const { return impl_->has_motion; }
ContactMeter& Barrier::meter() const { return impl_->search.meter(); }

std::vector<Vec3d> Barrier::obstacle_points(double time) const { return impl_->obstacles(time); }

std::vector<Vec3d> Barrier::points(Positions x, double time) const { return impl_->points(x, time); }

std::shared_ptr<const std::vector<ContactStencil>> Barrier::stencils(Positions x, double time) const {
  return impl_->search.at(impl_->points(x, time));
}

Vec3d Barrier::obstacle_displacement(const ContactStencil& stencil, std::span<const Vec3d> start,
                                     std::span<const Vec3d> end) const {
  Vec3d sum{};
  for (int k = 0; k < stencil.distance.count; ++k)
    if (const int p = stencil.point[stencil.distance.point[k]]; p >= 0 && impl_->mesh.row[p] < 0)
      sum = sum + std::abs(stencil.distance.c[k]) * (end[p] - start[p]);
  for (const ContactPlane& plane : impl_->mesh.planes)
    if (plane.part == stencil.parts[1]) sum = sum + (end[plane.point] - start[plane.point]);
  return sum;
}

double Barrier::obstacle_work(Positions x, double from, double to) const {
  if (!impl_->has_motion) return 0;
  const std::vector<Vec3d> start = impl_->points(x, from), end = impl_->points(x, to);
  double work = 0;
  for (const ContactStencil& stencil : *impl_->search.at(end)) {
    const auto g = stencil.gradient(end);
    Vec3d on_plane{};
    for (int k = 0; k < 4; ++k) {
      const int p = stencil.point[k];
      if (p < 0) continue;
      on_plane = on_plane - g[k];
      if (impl_->mesh.row[p] < 0) work += dot(g[k], end[p] - start[p]);
    }
    for (const ContactPlane& plane : impl_->mesh.planes)
      if (plane.part == stencil.parts[1]) work += dot(on_plane, end[plane.point] - start[plane.point]);
  }
  return work;
}

double Barrier::value(Positions x, const Context& context) const {
  const std::vector<Vec3d> p = impl_->points(x, context.time);
  const auto stencils = impl_->search.at(p);
  const ContactMeter::Span span(meter(), ContactMeter::forces);
  return parallel_sum(static_cast<int>(stencils->size()), [&](int first, int last) {
    double sum = 0;
    for (int k = first; k < last; ++k) sum += (*stencils)[k].value(p);
    return sum;
  });
}

void Barrier::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  const std::vector<Vec3d> p = impl_->points(x, context.time);
  const auto stencils = impl_->search.at(p);
  const ContactMeter::Span span(meter(), ContactMeter::forces);
  std::vector<std::array<Vec3d, 4>> forces(stencils->size());
  parallel_chunks(static_cast<int>(stencils->size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) forces[k] = (*stencils)[k].gradient(p);
  });
  for (size_t k = 0; k < stencils->size(); ++k)
    for (int i = 0; i < 4; ++i) {
      const int own = (*stencils)[k].point[i];
      if (own >= 0 && impl_->mesh.row[own] >= 0) add_vec(scale * forces[k][i], impl_->mesh.row[own], g);
    }
  if (impl_->has_motion && obstacle_end(context) != context.time)
    impl_->add_obstacle_pull(p, impl_->obstacle_moves(context.time, obstacle_end(context)), scale, g);
}

int Barrier::add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                         BlockSparse& H) const {
  const std::vector<Vec3d> p = impl_->points(x, context.time);
  const auto stencils = impl_->search.at(p);
  const ContactMeter::Span span(meter(), ContactMeter::forces);
  const Definiteness usual = projection.clamps_stencils ? Definiteness::clamped : Definiteness::exact;
  const Definiteness kind = projection.kind == Definiteness::exact ? usual : projection.kind;
  const auto kind_of = [&](const ContactStencil& stencil) {
    if (stencil.is_over_plane()) return Definiteness::exact;
    for (const int own : stencil.point)
      if (own >= 0 && impl_->mesh.row[own] >= 0 && projection.covers(impl_->mesh.row[own])) return kind;
    return usual;
  };
  std::vector<DistanceHessian> hessians(stencils->size());
  parallel_chunks(static_cast<int>(stencils->size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) hessians[k] = (*stencils)[k].hessian(p, kind_of((*stencils)[k]));
  });
  int modified = 0;
  for (size_t k = 0; k < stencils->size(); ++k) {
    Stencil added;
    modified += kind_of((*stencils)[k]) != Definiteness::exact;
    for (int i = 0; i < 4; ++i) {
      const int own = (*stencils)[k].point[i];
      added.row[i] = own >= 0 ? impl_->mesh.row[own] : -1;
      if (added.row[i] < 0) continue;
      Mat3d& diagonal = H.block[H.pattern->diagonal(added.row[i])];
      diagonal = diagonal + scale * hessians[k](i, i);
      for (int j = 0; j < i; ++j) added.block[i * (i - 1) / 2 + j] = scale * hessians[k](i, j);
    }
    H.stencils.push_back(added);
  }
  return modified;
}

int Barrier::add_stops(Positions x, const Context& context, std::span<const double> d, const ScaledModel& model) const {
  const ContactMeter::Span span(meter(), ContactMeter::bound);
  const auto& [scale, g, H] = model;
  const std::vector<Vec3d> p = impl_->points(x, context.time), u = impl_->displacements(d, context);
  const std::vector<Impact> impacts = StepBound(impl_->mesh, impl_->laws, impl_->search, impl_->sizes).impacts(p, u);
  for (const Impact& impact : impacts) {
    const Vec3d n = impact.distance.normal();
    double gap = 0;
    std::array<int, 4> row = {-1, -1, -1, -1};
    std::array<double, 4> c = {};
    for (int k = 0; k < impact.distance.count; ++k) {
      const int own = impact.point[impact.distance.point[k]];
      if (own < 0) continue;
      row[k] = impl_->mesh.row[own];
      gap += impact.distance.c[k] * dot(n, row[k] < 0 ? p[own] + u[own] : p[own]);
      c[k] = impact.distance.c[k];
    }
    const double k = scale * impact.stiffness;
    Stencil added{.row = row};
    for (int i = 0; i < 4; ++i) {
      if (row[i] < 0) continue;
      add_vec((k * (gap - impact.offset - impact.landing) * c[i]) * n, row[i], g);
      Mat3d& diagonal = H.block[H.pattern->diagonal(row[i])];
      diagonal = diagonal + (k * c[i] * c[i]) * outer(n, n);
      for (int j = 0; j < i; ++j) added.block[i * (i - 1) / 2 + j] = (k * c[i] * c[j]) * outer(n, n);
    }
    H.stencils.push_back(added);
  }
  return static_cast<int>(impacts.size());
}

double Barrier::max_step(Positions x, const Context& context, std::span<const double> d) const {
  const ContactMeter::Span span(meter(), ContactMeter::bound);
  return StepBound(impl_->mesh, impl_->laws, impl_->search, impl_->sizes)
      .largest(impl_->points(x, context.time), impl_->displacements(d, context));
}

double Barrier::max_step(Positions x, std::span<const double> d, double from, double to) const {
  const ContactMeter::Span span(meter(), ContactMeter::bound);
  return StepBound(impl_->mesh, impl_->laws, impl_->search, impl_->sizes)
      .largest(impl_->points(x, from), impl_->displacements(d, from, to));
}

std::vector<std::string> Barrier::blocked_parts(Positions x, double from, double to) const {
  const ContactMesh& mesh = impl_->mesh;
  const std::vector<Vec3d> start = impl_->points(x, from), end = impl_->points(x, to);
  const StepBound bound(mesh, impl_->laws, impl_->search, impl_->sizes);
  std::vector<std::string> names;
  for (const ContactPart& obstacle : mesh.parts) {
    if (!obstacle.motion) continue;
    std::vector<Vec3d> u(start.size());
    const int count = std::max(obstacle.point_count, 1);
    for (int p = obstacle.first_point; p < obstacle.first_point + count; ++p) u[p] = end[p] - start[p];
    std::set<int> bodies;
    for (const Impact& impact : bound.impacts(start, std::move(u)))
      for (const int p : impact.point)
        if (p >= 0 && mesh.row[p] >= 0) bodies.insert(mesh.part[p]);
    for (const int body : bodies) names.push_back(obstacle.name + " and " + mesh.parts[body].name);
  }
  return names;
}

std::vector<ContactPoint> Barrier::contact_points(Positions x, double time) const {
  if (!std::all_of(x.begin(), x.end(), [](double xi) { return std::isfinite(xi); })) return {};
  const std::vector<Vec3d> p = impl_->points(x, time);
  const auto stencils = impl_->search.at(p);
  std::vector<ContactPoint> at(p.size()), round;
  for (const ContactStencil& stencil : *stencils) {
    if (stencil.area == 0) continue;
    if (stencil.is_round) {
      round.push_back(foot_of(stencil, impl_->mesh, p));
      continue;
    }
    ContactPoint& point = at[stencil.point[0]];
    const double kappa = stencil.weight / stencil.area;
    point.gap = std::min(point.gap, stencil.gap());
    point.pressure -= std::copysign(kappa, stencil.area) * stencil.b().first;
  }
  std::vector<ContactPoint> touching = std::move(round);
  for (size_t i = 0; i < at.size(); ++i)
    if (std::isfinite(at[i].gap)) touching.push_back({impl_->mesh.row[i], p[i], at[i].gap, at[i].pressure});
  return touching;
}

ContactSummary Barrier::summary(Positions x, double time) const {
  const auto stencils = this->stencils(x, time);
  ContactSummary summary{.contacts = static_cast<int>(stencils->size())};
  for (const ContactStencil& stencil : *stencils) {
    if (stencil.gap() < summary.min_gap)
      summary.min_gap = stencil.gap(), summary.parts = stencil.parts, summary.reach = stencil.reach;
    summary.widest_reach = std::max(summary.widest_reach, stencil.reach);
    summary.gap_work -= stencil.weight * stencil.b().first * stencil.gap();
  }
  for (const ContactPoint& point : contact_points(x, time))
    summary.max_pressure = std::max(summary.max_pressure, point.pressure);
  return summary;
}

ContactEnergy Barrier::energy(Positions x, double time) const {
  const std::vector<Vec3d> p = impl_->points(x, time);
  struct Share {
    double energy = 0, gap = std::numeric_limits<double>::infinity();
  };
  std::map<std::array<int, 2>, Share> shares;
  ContactEnergy all;
  for (const ContactStencil& stencil : *impl_->search.at(p)) {
    const auto [first, second] = std::minmax(stencil.parts[0], stencil.parts[1]);
    Share& share = shares[{first, second}];
    share.energy += stencil.value(p);
    share.gap = std::min(share.gap, stencil.gap());
    all.total += stencil.value(p);
  }
  double most = 0;
  for (const auto& [parts, share] : shares)
    if (share.energy > most) most = share.energy, all.parts = parts, all.gap = share.gap;
  return all;
}

}  // namespace aspic
