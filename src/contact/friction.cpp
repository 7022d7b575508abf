#include "contact/friction.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kStaticReach = 1e-2;  // width of f in statics, relative to the reach of the barrier

// Identifies a contact within a step: a point and a part, or two edges.
using ContactName = std::array<int, 5>;

struct Weight {
  int row;
  double factor;
};

// A contact that may slide along a surface. Its slip is a weighted sum of displacements of vertices.
struct Slider {
  std::vector<Weight> weights;  // of different rows
  std::array<Vec3d, 2> tangent = {};
  double force = 0;  // mu lambda [N]
  double width = 0;  // e [m]
  Vec3d moved = {};  // displacement of the obstacle from StepContext::start [m]
  Vec3d way = {};    // displacement of the obstacle during the step [m]
  std::array<int, 2> parts = {};
  ContactName name = {};
};

// A normal force, and the stencils that share it.
struct Traction {
  std::span<const ContactStencil> stencils;
  std::vector<double> share;  // shares of the stencils, which sum to 1
  Vec3d force{};              // [N]
};

ContactName name_of(const ContactStencil& stencil) {
  if (stencil.is_round || stencil.is_of_edges())
    return {stencil.point[0], stencil.point[1], stencil.point[2], stencil.point[3], stencil.parts[1]};
  return {stencil.point[0], -1, -1, -1, stencil.parts[1]};
}

// A normal force times mu before and after an update [N].
struct ForceChange {
  double before = 0, after = 0;
  double size() const { return after - before; }
};

struct Update {
  std::map<ContactName, ForceChange> changes;
  double part = 1;  // of the changes that was made

  double change(const ContactName& name) const {
    const auto found = changes.find(name);
    return found == changes.end() ? 0 : found->second.size();
  }
};

Update update_between(std::span<const Slider> before, std::span<const Slider> after) {
  Update update;
  for (const Slider& slider : before) update.changes[slider.name].before = slider.force;
  for (const Slider& slider : after) update.changes[slider.name].after = slider.force;
  return update;
}

// Returns the part to make of the second of two updates by the secant through both, after which the next update changes
// nothing [Irons 1969]: less than 1 if they are nearly opposite, or the first was relaxed, too, and more if they are
// nearly equal.
double relaxation(const Update& first, const Update& second) {
  constexpr double kOpposite = -0.5, kEqual = 0.99;  // cosines
  constexpr double kLeast = 0.1, kMost = 20;
  double squares[2] = {}, product = 0;
  for (const auto& [name, change] : first.changes) squares[0] += change.size() * change.size();
  for (const auto& [name, change] : second.changes) {
    squares[1] += change.size() * change.size();
    product += change.size() * first.change(name);
  }
  const double size = std::sqrt(squares[0] * squares[1]);
  const bool are_opposite = product < kOpposite * size, are_equal = first.part == 1 && product > kEqual * size;
  if (first.part >= 1 && !are_opposite && !are_equal) return 1;
  const double difference = squares[0] + squares[1] - 2 * product;
  if (!(difference > 0)) return 1;
  const double part = first.part * (squares[0] - product) / difference;
  return are_equal ? std::clamp(part, 1.0, kMost) : std::clamp(part, kLeast, 1.0);
}

struct FrictionContext : Energy::Context {
  std::vector<double> start;
  double obstacle_time = 0;               // time of the obstacles at the start [s]
  std::optional<double> obstacle_before;  // see StepContext
  std::vector<Slider> sliders;
  std::optional<std::vector<Slider>> before;   // the sliders before the last update of this step
  std::optional<std::vector<Slider>> updated;  // the sliders of the last update, if it was relaxed
  std::map<ContactName, Slider> known;         // sliders of earlier updates
  std::map<ContactName, double> predicted;     // mu lambda after the last Newton step [N]
  Update earlier_update, last_update;
};

const FrictionContext& friction(const Energy::Context& context) { return static_cast<const FrictionContext&>(context); }

struct Dissipation {
  double value, first, second;  // f, f', f''
};

Dissipation dissipation(double y, double e) {
  if (y >= e) return {y - e / 3, 1, 0};
  const double s = y / e;
  return {y * s * (1 - s / 3), s * (2 - s), 2 * (1 - s) / e};
}

// Returns whether both stencils belong to the same point and the same other part. The center of a sphere has many
// contacts.
bool is_of_same_point(const ContactStencil& a, const ContactStencil& b) {
  return !a.is_round && !a.is_of_edges() && !b.is_of_edges() && a.point[0] == b.point[0] && a.parts == b.parts;
}

// Returns the normal force between a point and a part, or between two edges. In a concave crease it is the sum over two
// faces minus the force of their edge. The shares distribute it over the stencils, so that it is continuous where the
// closest face changes.
Traction traction_of(std::span<const ContactStencil> stencils, std::span<const Vec3d> points) {
  Traction traction{.stencils = stencils};
  std::vector<Vec3d> forces;
  for (const ContactStencil& stencil : stencils) {
    const auto g = stencil.gradient(points);
    forces.push_back(stencil.is_of_edges() ? -1.0 * (g[0] + g[1]) : -1.0 * g[0]);
    traction.force = traction.force + forces.back();
  }
  const double square = dot(traction.force, traction.force);
  for (const Vec3d& force : forces) traction.share.push_back(square > 0 ? dot(force, traction.force) / square : 0);
  return traction;
}

void add_weight(const Weight& added, std::vector<Weight>& weights) {
  for (Weight& weight : weights)
    if (weight.row == added.row) {
      weight.factor += added.factor;
      return;
    }
  weights.push_back(added);
}

Slider slider_of(const ContactMesh& mesh, const Traction& traction, double force, double width) {
  constexpr double kRoundOff = 1e-12;  // round-off of canceling forces of a face and its edge
  Slider slider{.force = force, .width = width};
  slider.tangent = tangents({.r = traction.force, .d = norm(traction.force)});
  for (size_t s = 0; s < traction.stencils.size(); ++s) {
    const ContactStencil& stencil = traction.stencils[s];
    for (int k = 0; k < stencil.distance.count; ++k)
      if (const int p = stencil.point[stencil.distance.point[k]]; p >= 0 && mesh.row[p] >= 0)
        add_weight({mesh.row[p], traction.share[s] * stencil.distance.c[k]}, slider.weights);
  }
  std::erase_if(slider.weights, [](const Weight& weight) { return std::abs(weight.factor) < kRoundOff; });
  return slider;
}

// Returns 1 if the obstacle of a stencil is its second feature, else -1.
double side(const ContactMesh& mesh, const ContactStencil& stencil) {
  return mesh.parts[stencil.parts[0]].is_obstacle ? -1 : 1;
}

using Slip = std::array<double, 2>;  // tangential relative displacement since the start
using Stiffness = std::array<std::array<double, 2>, 2>;

Slip slip(const Slider& slider, Positions x, Positions start) {
  Vec3d d = -1.0 * slider.moved;
  for (const auto& [row, factor] : slider.weights) d = d + factor * (point(x, row) - point(start, row));
  return {dot(slider.tangent[0], d), dot(slider.tangent[1], d)};
}

Slip change_of_slip(const Slider& slider, std::span<const double> d) {
  Vec3d sum{};
  for (const auto& [row, factor] : slider.weights) sum = sum + factor * point(d, row);
  return {dot(slider.tangent[0], sum), dot(slider.tangent[1], sum)};
}

void add_force(const Slider& slider, const Slip& f, std::span<double> g) {
  const Vec3d force = f[0] * slider.tangent[0] + f[1] * slider.tangent[1];
  for (const auto& [row, factor] : slider.weights) add_vec(factor * force, row, g);
}

struct Path {
  Positions x, start;
};

// g += scale * forces at x.
void add_forces(std::span<const Slider> sliders, const Path& path, double scale, std::span<double> g) {
  for (const Slider& slider : sliders) {
    const auto u = slip(slider, path.x, path.start);
    const double y = std::hypot(u[0], u[1]);
    if (y == 0) continue;
    const double size = scale * slider.force * dissipation(y, slider.width).first / y;
    add_force(slider, {size * u[0], size * u[1]}, g);
  }
}

// Adds the blocks w_i w_j K for i > j, as one stencil per two pairs of rows.
void add_pairs(std::span<const Weight> weights, const Mat3d& K, BlockSparse& H) {
  const int count = static_cast<int>(weights.size()), pairs = std::max(2, (count + 1) / 2);
  if (count < 2) return;
  for (int high = 1; high < pairs; ++high)
    for (int low = 0; low < high; ++low) {
      const std::array<int, 4> own = {2 * low, 2 * low + 1, 2 * high, 2 * high + 1};
      const bool is_next =
          high == low + 1;  // with the block inside the low pair; the last one also inside the high pair
      Stencil added;
      for (int i = 0; i < 4; ++i) {
        if (own[i] >= count) continue;
        added.row[i] = weights[own[i]].row;
        for (int j = 0; j < i; ++j)
          if (i / 2 != j / 2 || (is_next && (i == 1 || high == pairs - 1)))
            added.block[i * (i - 1) / 2 + j] = (weights[own[i]].factor * weights[own[j]].factor) * K;
      }
      H.stencils.push_back(added);
    }
}

void add_stiffness(const Slider& slider, const Stiffness& k, double scale, BlockSparse& H) {
  Mat3d K{};
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) K(r, c) += scale * k[a][b] * slider.tangent[a][r] * slider.tangent[b][c];
  for (const auto& [row, factor] : slider.weights) {
    Mat3d& diagonal = H.block[H.pattern->diagonal(row)];
    diagonal = diagonal + (factor * factor) * K;
  }
  add_pairs(slider.weights, K, H);
}

// Returns the Hessian of a slider with respect to its slip.
Stiffness stiffness(const Slider& slider, const Slip& u) {
  const double y = std::hypot(u[0], u[1]);
  const Dissipation f = dissipation(y, slider.width);
  const double across = y > 0 ? f.first / y : 2 / slider.width, along = f.second;
  Stiffness k;
  for (int a = 0; a < 2; ++a)
    for (int b = 0; b < 2; ++b)
      k[a][b] = slider.force * ((a == b ? across : 0) + (y > 0 ? (along - across) * u[a] * u[b] / (y * y) : 0));
  return k;
}

}  // namespace

std::unique_ptr<Energy::Context> Friction::make_context() const { return std::make_unique<FrictionContext>(); }

void Friction::begin_step(const StepContext& step, Context& context) const {
  Energy::begin_step(step, context);
  auto& own = static_cast<FrictionContext&>(context);
  own.start.assign(step.start.begin(), step.start.end());
  own.obstacle_time = step.obstacle_time.value_or(step.time - step.h);
  own.obstacle_before = step.obstacle_before;
  own.before.reset();
  own.updated.reset();
  own.last_update = {};
  own.known.clear();
  own.predicted.clear();
  lag(step.shape.empty() ? step.start : step.shape, own.obstacle_time, false, context);
}

void Friction::update_lagged(Positions x, bool keeps_directions, Context& context) const {
  auto& own = static_cast<FrictionContext&>(context);
  own.before = std::move(own.sliders);
  own.updated.reset();
  lag(x, context.time, keeps_directions, context);
  own.earlier_update = std::exchange(own.last_update, update_between(*own.before, own.sliders));
}

bool Friction::relax_lagged(Context& context) const {
  auto& own = static_cast<FrictionContext&>(context);
  if (!own.before) return false;
  const double part = own.last_update.part = relaxation(own.earlier_update, own.last_update);
  if (part == 1) return false;
  own.updated = own.sliders;
  for (Slider& slider : own.sliders)
    slider.force = std::max(0.0, slider.force - (1 - part) * own.last_update.changes[slider.name].size());
  for (const Slider& slider : *own.before)
    if (part < 1 && own.last_update.changes[slider.name].after == 0) {
      own.sliders.push_back(slider);
      own.sliders.back().force *= 1 - part;
    }
  return true;
}

// Visits the normal force between each point and part, and between two edges, with its stencils.
template <class Visit>
void Friction::visit_tractions(Positions x, double time, const Visit& visit) const {
  const std::vector<Vec3d> points = barrier_.points(x, time);
  const auto stencils = barrier_.stencils(x, time);
  const ContactMeter::Span span(barrier_.meter(), ContactMeter::forces);
  for (size_t k = 0; k < stencils->size();) {
    const size_t first = k;
    for (++k; k < stencils->size() && is_of_same_point((*stencils)[first], (*stencils)[k]);) ++k;
    const auto& [a, b] = (*stencils)[first].parts;
    if (barrier_.laws()(a, b).friction == 0) continue;
    const Traction traction = traction_of(std::span(*stencils).subspan(first, k - first), points);
    if (squared_norm(traction.force) > 0) visit(traction, barrier_.laws()(a, b));
  }
}

// The closest points of a stencil move by u, so its force grows by the factor 1 + b'' (n . u) / b'.
void Friction::note_newton_step(Positions x, std::span<const double> d, double alpha, Context& context) const {
  auto& own = static_cast<FrictionContext&>(context);
  own.predicted.clear();
  if (x.empty()) return;
  const ContactMesh& mesh = barrier_.mesh();
  visit_tractions(x, context.time, [&](const Traction& traction, const ContactLaw& law) {
    double growth = 0;
    for (size_t s = 0; s < traction.stencils.size(); ++s) {
      const ContactStencil& stencil = traction.stencils[s];
      double opening = 0;
      for (int k = 0; k < stencil.distance.count; ++k)
        if (const int p = stencil.point[stencil.distance.point[k]]; p >= 0 && mesh.row[p] >= 0)
          opening += stencil.distance.c[k] * dot(stencil.distance.normal(), point(d, mesh.row[p]));
      if (const BarrierValue b = stencil.b(); b.first < 0)
        growth += traction.share[s] * alpha * b.second / b.first * opening;
    }
    own.predicted[name_of(traction.stencils[0])] = law.friction * norm(traction.force) * std::max(0.0, 1 + growth);
  });
}

void Friction::lag(Positions x, double time, bool keeps_directions, Context& context) const {
  auto& own = static_cast<FrictionContext&>(context);
  std::vector<Vec3d> start, end, extrapolated;
  if (barrier_.has_moving_obstacle()) {
    start = extrapolated = barrier_.points(x, own.obstacle_time), end = barrier_.points(x, context.time);
    if (own.obstacle_before) {
      const std::vector<Vec3d> before = barrier_.points(x, *own.obstacle_before);
      for (size_t p = 0; p < start.size(); ++p) extrapolated[p] = start[p] + (1.0 / 3) * (start[p] - before[p]);
    }
  }
  own.sliders.clear();
  visit_tractions(x, time, [&](const Traction& traction, const ContactLaw& law) {
    const ContactName name = name_of(traction.stencils[0]);
    const auto predicted = own.predicted.find(name);
    const double force = predicted != own.predicted.end() ? predicted->second : law.friction * norm(traction.force);
    const double width = context.h > 0 ? speed_ * context.h : kStaticReach * law.reach;
    Slider& slider = own.sliders.emplace_back(slider_of(barrier_.mesh(), traction, force, width));
    slider.parts = traction.stencils[0].parts;
    slider.name = name;
    for (size_t s = 0; s < traction.stencils.size() && !start.empty(); ++s) {
      const ContactStencil& stencil = traction.stencils[s];
      const double share = traction.share[s] * side(barrier_.mesh(), stencil);
      slider.moved = slider.moved + share * barrier_.obstacle_displacement(stencil, extrapolated, end);
      slider.way = slider.way + share * barrier_.obstacle_displacement(stencil, start, end);
    }
    Slider& known = own.known.try_emplace(name, slider).first->second;
    if (keeps_directions)
      slider = known, slider.force = force;
    else
      known = slider;
  });
}

double Friction::obstacle_work(Positions x, const Context& context) const {
  const FrictionContext& own = friction(context);
  double work = 0;
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    const double y = std::hypot(u[0], u[1]);
    if (y == 0) continue;
    const double size = slider.force * dissipation(y, slider.width).first / y;
    for (int a = 0; a < 2; ++a) work -= size * u[a] * dot(slider.tangent[a], slider.way);
  }
  return work;
}

double Friction::value(Positions x, const Context& context) const {
  const ContactMeter::Span span(barrier_.meter(), ContactMeter::forces);
  const FrictionContext& own = friction(context);
  double sum = 0;
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    sum += slider.force * dissipation(std::hypot(u[0], u[1]), slider.width).value;
  }
  return sum;
}

void Friction::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  const ContactMeter::Span span(barrier_.meter(), ContactMeter::forces);
  const FrictionContext& own = friction(context);
  add_forces(own.sliders, {x, own.start}, scale, g);
}

void Friction::add_change(Positions x, const Context& context, std::span<double> g) const {
  const FrictionContext& own = friction(context);
  if (!own.before) return;
  add_forces(own.updated ? *own.updated : own.sliders, {x, own.start}, 1, g);
  add_forces(*own.before, {x, own.start}, -1, g);
}

std::array<int, 2> Friction::parts_at(int row, const Context& context) const {
  const FrictionContext& own = friction(context);
  std::array<int, 2> parts = {-1, -1};
  double most = 0;
  const auto compare = [&](const std::vector<Slider>& sliders) {
    for (const Slider& slider : sliders)
      for (const Weight& weight : slider.weights)
        if (const double size = slider.force * std::abs(weight.factor); weight.row == row && size > most)
          most = size, parts = slider.parts;
  };
  compare(own.sliders);
  if (own.before) compare(*own.before);
  return parts;
}

double Friction::creep(Positions x, const Context& context) const {
  const FrictionContext& own = friction(context);
  double most = 0;
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    if (const double y = std::hypot(u[0], u[1]); y < slider.width) most = std::max(most, y);
  }
  return most;
}

// f is convex, so the Hessian needs no modification.
int Friction::add_hessian(Positions x, const Context& context, double scale, const Projection&, BlockSparse& H) const {
  const ContactMeter::Span span(barrier_.meter(), ContactMeter::forces);
  const FrictionContext& own = friction(context);
  for (const Slider& slider : own.sliders)
    add_stiffness(slider, stiffness(slider, slip(slider, x, own.start)), scale, H);
  return 0;
}

// A slider that d moves backward past its start is likely to stick. Newton's method on f would overshoot, because f'' =
// 0 while it slides. Models it as a sticking slider with the force 2 f u / e.
int Friction::add_stops(Positions x, const Context& context, std::span<const double> d,
                        const ScaledModel& model) const {
  const ContactMeter::Span span(barrier_.meter(), ContactMeter::forces);
  const auto& [scale, g, H] = model;
  const FrictionContext& own = friction(context);
  int count = 0;
  for (const Slider& slider : own.sliders) {
    const Slip u = slip(slider, x, own.start), du = change_of_slip(slider, d);
    const double y = std::hypot(u[0], u[1]), e = slider.width;
    if (y <= e || u[0] * (u[0] + du[0]) + u[1] * (u[1] + du[1]) > -y * e) continue;
    ++count;
    Stiffness added = stiffness(slider, u);
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) added[a][b] = (a == b ? 2 * slider.force / e : 0) - added[a][b];
    add_stiffness(slider, added, scale, H);
    const double size = scale * slider.force * (2 / e - 1 / y);
    add_force(slider, {size * u[0], size * u[1]}, g);
  }
  return count;
}

}  // namespace aspic
