#include "contact/barrier.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "contact/stencil_search.h"
#include "math/vectors.h"
#include "mesh/ccd.h"

namespace aspic {
namespace {

constexpr double kLanding = 0.5;  // gap at which a step ends, relative to the reach

constexpr double kFar = 0.1;              // of the size of a part
constexpr double kShortest = 1.0 / 1024;  // step that is worth a search for pairs

std::vector<double> sizes_of(const ContactMesh& mesh) {
  std::vector<double> sizes;
  for (const ContactPart& part : mesh.parts) {
    Box box;
    for (int i = 0; i < part.point_count; ++i) box.add(mesh.rest[part.first_point + i]);
    sizes.push_back(part.point_count > 0 ? norm(box.upper - box.lower) : 0);
  }
  return sizes;
}

// As in StepRule.
double landing_gap(double gap, double reach) { return gap > reach ? kLanding * reach : 0.2 * gap; }

}  // namespace

struct Barrier::Impl {
  Impl(ContactMesh m, const ContactOptions& options)
      : mesh(std::move(m)), sizes(sizes_of(mesh)), laws(mesh, options), search(mesh, laws) {}

  // Positions of all points: variables from x, obstacles from the mesh.
  std::vector<Vec3d> points(Positions x) const {
    std::vector<Vec3d> p = mesh.rest;
    for (int i = 0; i < mesh.point_count(); ++i)
      if (mesh.row[i] >= 0) p[i] = point(x, mesh.row[i]);
    return p;
  }
  std::vector<Vec3d> displacements(std::span<const double> d) const {
    std::vector<Vec3d> u(mesh.rest.size());
    for (int i = 0; i < mesh.point_count(); ++i)
      if (mesh.row[i] >= 0) u[i] = point(d, mesh.row[i]);
    return u;
  }

  // A step of at most 1 on which no point moves further than kFar relative to its part. Longer ones have too many
  // candidates.
  double longest_step(std::span<const Vec3d> u) const {
    double step = 1;
    const std::vector<Vec3d> relative = relative_to_parts(mesh, u);
    for (int i = 0; i < mesh.point_count(); ++i)
      if (const double far = norm(relative[i]), most = kFar * sizes[mesh.part[i]]; far * step > most) step = most / far;
    return step;
  }

  ContactMesh mesh;
  std::vector<double> sizes;  // of the parts at rest [m]
  ContactLaws laws;
  StencilSearch search;
};

Barrier::Barrier(ContactMesh mesh, const ContactOptions& options)
    : impl_(std::make_unique<Impl>(std::move(mesh), options)) {}
Barrier::~Barrier() = default;

const ContactMesh& Barrier::mesh() const { return impl_->mesh; }
const ContactLaws& Barrier::laws() const { return impl_->laws; }
int Barrier::self_touching_point() const { return impl_->search.self_touching_point(); }

std::shared_ptr<const std::vector<ContactStencil>> Barrier::stencils(Positions x) const {
  return impl_->search.at(impl_->points(x));
}

double Barrier::value(Positions x, const Context&) const {
  const std::vector<Vec3d> p = impl_->points(x);
  const auto stencils = impl_->search.at(p);
  return parallel_sum(static_cast<int>(stencils->size()), [&](int first, int last) {
    double sum = 0;
    for (int k = first; k < last; ++k) sum += (*stencils)[k].value(p);
    return sum;
  });
}

void Barrier::add_gradient(Positions x, const Context&, double scale, std::span<double> g) const {
  const std::vector<Vec3d> p = impl_->points(x);
  const auto stencils = impl_->search.at(p);
  std::vector<std::array<Vec3d, 4>> forces(stencils->size());
  parallel_chunks(static_cast<int>(stencils->size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) forces[k] = (*stencils)[k].gradient(p);
  });
  for (size_t k = 0; k < stencils->size(); ++k)
    for (int i = 0; i < 4; ++i) {
      const int own = (*stencils)[k].point[i];
      if (own >= 0 && impl_->mesh.row[own] >= 0) add_vec(scale * forces[k][i], impl_->mesh.row[own], g);
    }
}

int Barrier::add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                         BlockSparse& H) const {
  const std::vector<Vec3d> p = impl_->points(x);
  const auto stencils = impl_->search.at(p);
  const auto kind_of = [&](const ContactStencil& stencil) {
    for (const int own : stencil.point)
      if (own >= 0 && impl_->mesh.row[own] >= 0 && projection.covers(impl_->mesh.row[own])) return projection.kind;
    return Definiteness::exact;
  };
  std::vector<DistanceHessian> hessians(stencils->size());
  parallel_chunks(static_cast<int>(stencils->size()), [&](int first, int last) {
    for (int k = first; k < last; ++k) hessians[k] = (*stencils)[k].hessian(p, kind_of((*stencils)[k]));
  });
  int modified = 0;
  for (size_t k = 0; k < stencils->size(); ++k) {
    Stencil added;
    bool is_coupled = false;
    modified += kind_of((*stencils)[k]) != Definiteness::exact;
    for (int i = 0; i < 4; ++i) {
      const int own = (*stencils)[k].point[i];
      added.row[i] = own >= 0 ? impl_->mesh.row[own] : -1;
      if (added.row[i] < 0) continue;
      Mat3d& diagonal = H.block[H.pattern->diagonal(added.row[i])];
      diagonal = diagonal + scale * hessians[k](i, i);
      for (int j = 0; j < i; ++j) {
        added.block[i * (i - 1) / 2 + j] = scale * hessians[k](i, j);
        is_coupled = is_coupled || (added.row[j] >= 0 && squared_norm(hessians[k](i, j)) > 0);
      }
    }
    if (is_coupled) H.stencils.push_back(added);
  }
  return modified;
}

double Barrier::max_step(Positions x, const Context&, std::span<const double> d) const {
  const ContactMesh& mesh = impl_->mesh;
  const std::vector<Vec3d> p = impl_->points(x);
  std::vector<Vec3d> u = impl_->displacements(d);
  double limit = impl_->longest_step(u);
  for (Vec3d& ui : u) ui = limit * ui;
  std::shared_ptr<const ContactCandidates> candidates;
  while (!(candidates = impl_->search.along(p, u))) {
    limit /= 2;
    for (Vec3d& ui : u) ui = 0.5 * ui;
    if (limit < kShortest) return 0;
  }
  const auto smallest = [](int count, const auto& step_of) {
    std::vector<double> steps(count / kChunkSize + 1, 1.0);
    parallel_chunks(count, [&](int first, int last) {
      double step = 1;
      for (int i = first; i < last; ++i) step = std::min(step, step_of(i, step));
      steps[first / kChunkSize] = step;
    });
    return *std::min_element(steps.begin(), steps.end());
  };
  const auto step_of_point = [&](int i, double step) {
    if (mesh.row[i] >= 0)
      for (const ContactPlane& plane : mesh.planes) {
        const double gap = dot(plane.normal, p[i] - plane.origin), rate = dot(plane.normal, u[i]);
        const double reach = impl_->laws(mesh.part[i], plane.part).reach;
        if (rate < 0) step = std::min(step, std::max(0.0, (gap - landing_gap(gap, reach)) / -rate));
      }
    for (const int t : candidates->triangles_near(i)) {
      const auto& [a, b, c] = mesh.triangles[t];
      const MovingPair moving{PairKind::point_triangle, {p[i], p[a], p[b], p[c]}, {u[i], u[a], u[b], u[c]}};
      const double reach = impl_->laws(mesh.part[i], mesh.part[a]).reach;
      step = largest_step(moving, {.landing = kLanding * reach, .horizon = step}).alpha;
    }
    return step;
  };
  const auto step_of_edges = [&](int k, double step) {
    const EdgePair& pair = candidates->edge_pairs[k];
    const auto& [a, b] = mesh.edges[pair.first];
    const auto& [e, f] = mesh.edges[pair.second];
    const MovingPair moving{PairKind::edge_edge, {p[a], p[b], p[e], p[f]}, {u[a], u[b], u[e], u[f]}};
    return largest_step(moving, {.landing = kLanding * pair.reach, .horizon = step}).alpha;
  };
  return limit * std::min(smallest(mesh.point_count(), step_of_point),
                          smallest(static_cast<int>(candidates->edge_pairs.size()), step_of_edges));
}

std::vector<ContactPoint> Barrier::contact_points(Positions x) const {
  if (!std::all_of(x.begin(), x.end(), [](double xi) { return std::isfinite(xi); })) return {};
  const std::vector<Vec3d> p = impl_->points(x);
  const auto stencils = impl_->search.at(p);
  std::vector<ContactPoint> at(p.size());
  for (const ContactStencil& stencil : *stencils) {
    if (stencil.area == 0) continue;
    ContactPoint& point = at[stencil.point[0]];
    const double kappa = stencil.weight / stencil.area;
    point.gap = std::min(point.gap, stencil.distance.d);
    point.pressure -= std::copysign(kappa, stencil.area) * stencil.b().first;
  }
  std::vector<ContactPoint> touching;
  for (size_t i = 0; i < at.size(); ++i)
    if (std::isfinite(at[i].gap)) touching.push_back({impl_->mesh.row[i], p[i], at[i].gap, at[i].pressure});
  return touching;
}

ContactSummary Barrier::summary(Positions x) const {
  const auto stencils = this->stencils(x);
  ContactSummary summary{.contacts = static_cast<int>(stencils->size())};
  for (const ContactStencil& stencil : *stencils) summary.min_gap = std::min(summary.min_gap, stencil.distance.d);
  for (const ContactPoint& point : contact_points(x))
    summary.max_pressure = std::max(summary.max_pressure, point.pressure);
  return summary;
}

}  // namespace aspic
