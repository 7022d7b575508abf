#include "dynamics/simulation_checks.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "base/error.h"
#include "base/formatted.h"
#include "contact/barrier.h"
#include "contact/contact_reach.h"
#include "contact/overlaps.h"
#include "math/vectors.h"
#include "mesh/findings.h"
#include "mesh/surface_locator.h"

namespace aspic {
namespace {

std::string listed(const std::vector<int>& indices) {
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(indices.size(), 5); ++i) text += (i ? ", " : "") + std::to_string(indices[i]);
  return text + (indices.size() > 5 ? ", ..." : "");
}

std::string coordinates(const Vec3d& x) { return formatted("%.4g, %.4g, %.4g", x[0], x[1], x[2]); }

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (size_t i = 0; i < names.size(); ++i) text += (i == 0 ? "" : i + 1 < names.size() ? ", " : " and ") + names[i];
  return text;
}

std::optional<SolverConflict> budget_conflict(const SimulationOptions& options, const Integrator& integrator) {
  const double budget = options.solver.time_budget;
  if (budget == 0) return std::nullopt;
  std::string reason;
  if (!(budget > 0) || !std::isfinite(budget))
    reason = "must be positive, or 0 for none";
  else if (!integrator.facts().is_implicit || integrator.facts().takes_one_iteration)
    reason = "has no effect on integrator = '" + options.integrator + "', whose steps cannot end early";
  else if (options.adaptive.tolerance > 0)
    reason = "cannot be combined with adaptive steps, which are divided until they are accurate";
  else if (options.solver.minimize.line_search.test == DecreaseTest::none)
    reason = "needs a line search, which test = 'none' disables: otherwise E may increase before the deadline";
  if (reason.empty()) return std::nullopt;
  return SolverConflict{"time_budget", "time_budget = " + std::to_string(budget) + " " + reason};
}

// Returns the largest distance of points of a sheet behind the surface of a solid [m]; 0 for two sheets or two solids.
double depth_of_sheet(const ContactMesh& contact, std::span<const Vec3d> x, const std::array<int, 2>& parts) {
  const bool is_first = contact.parts[parts[0]].is_hollow;
  if (is_first == contact.parts[parts[1]].is_hollow) return 0;
  const int sheet = parts[is_first ? 0 : 1], solid = parts[is_first ? 1 : 0];
  std::vector<Triangle> surface;
  for (const Triangle& t : contact.triangles)
    if (contact.part[t[0]] == solid) surface.push_back(t);
  const SurfaceLocator locator(x, surface);
  double depth = 0;
  for (int p = 0; p < contact.point_count(); ++p) {
    if (contact.part[p] != sheet) continue;
    const ClosestPoint closest = locator.nearest(x[p]);
    const auto& [a, b, c] = surface[closest.triangle];
    if (dot(cross(x[b] - x[a], x[c] - x[a]), x[p] - closest.position) < 0) depth = std::max(depth, closest.distance);
  }
  return depth;
}

// What to do about parts that overlap.
std::string remedy_of_overlap(const ContactMesh& contact, const std::array<int, 2>& parts) {
  const bool is_thin = contact.parts[parts[0]].is_hollow || contact.parts[parts[1]].is_hollow;
  return is_thin ? "; move them apart, or let the sheet start larger, as by deform = { scale = 1.1 }, from which it "
                   "contracts to its rest shape"
                 : "; move them apart";
}

// Rejects surfaces that intersect. The message lists the first pairs of parts with a location for each.
void require_no_intersection(const ContactMesh& contact, std::span<const Vec3d> x) {
  constexpr size_t kMaxListed = 10;
  const Overlaps found = overlaps(contact, x);
  if (found.pairs.empty()) return;
  std::string text;
  for (size_t i = 0; i < std::min(found.pairs.size(), kMaxListed); ++i) {
    const auto& [parts, place] = found.pairs[i];
    text += (i == 0 ? "" : "; ") + contact.parts[parts[0]].name + " and " + contact.parts[parts[1]].name + " near (" +
            coordinates(place) + ") m";
    if (const double depth = depth_of_sheet(contact, x, parts); depth > 0)
      text += ", up to " + three_digits(depth) + " m deep";
  }
  throw InvalidInput("surfaces intersect in the initial state: " + text +
                     (found.pairs.size() > kMaxListed ? "; ..." : "") + " (" + std::to_string(found.count) +
                     (found.is_complete ? "" : " or more") + " pairs of triangles)" +
                     remedy_of_overlap(contact, found.pairs[0].parts));
}

// Rejects solids inside of other solids. Bodies may start inside of a closed obstacle, which contains them.
void require_outside(const ContactMesh& contact, std::span<const Vec3d> x) {
  for (const auto& [inner, outer, place] : enclosed_parts(contact, x))
    if (!contact.parts[outer].is_obstacle)
      throw InvalidInput((contact.parts[inner].is_obstacle ? "obstacle '" : "body '") + contact.parts[inner].name +
                         "' starts inside of body '" + contact.parts[outer].name + "', near (" + coordinates(place) +
                         ") m; move it out, or give the body a cavity");
}

std::string unit_hint_of(const ContactMesh& contact, int part, std::span<const Vec3d> x) {
  Box box;
  for (int p = 0; p < contact.point_count(); ++p)
    if (contact.part[p] == part) box.add(x[p]);
  const std::string hint = unit_hint(box);
  return hint.empty() ? "" : "; its " + hint;
}

// Rejects vertices behind a plane, or on it.
void require_before_planes(const Model& model, std::span<const Vec3d> x) {
  const ContactMesh& contact = model.contact->mesh();
  for (const ContactPlane& plane : contact.planes)
    for (int p = 0; p < contact.point_count(); ++p) {
      if (contact.row[p] < 0) continue;
      const ContactLaw& law = model.contact->laws()(contact.part[p], plane.part);
      const double height = dot(plane.normal, x[p] - x[plane.point]) - law.offset;
      if (height > 0) continue;
      const std::string body = "body '" + contact.parts[contact.part[p]].name + "'",
                        floor = "'" + contact.parts[plane.part].name + "'";
      const std::string vertex = "vertex " + std::to_string(model.numbering.vertex.to_user(contact.row[p]));
      const bool is_touching = -height <= kTouching * law.edge;
      throw InvalidInput(is_touching
                             ? body + " touches the plane " + floor + " at the start, at " + vertex + "; leave a gap"
                             : body + " starts behind the plane " + floor + ": " + vertex + " by " +
                                   three_digits(-height) + " m; move it" + unit_hint_of(contact, contact.part[p], x));
    }
}

}  // namespace

void require_mass(const Model& model, const Pins& pins) {
  std::vector<int> massless;
  for (int v = 0; v < model.mesh.vertex_count(); ++v)
    if (!pins.holds(v) && !(model.mass->vertex_mass()[v] > 0)) massless.push_back(v);
  if (!massless.empty())
    throw BadInitialState(BadInitialState::Kind::no_mass,
                          std::to_string(massless.size()) + " vertices have no mass (" +
                              listed(model.numbering.vertex.to_user(massless)) +
                              "): they belong to no tet, or the density there is zero",
                          "remove them or pin them");
}

void require_finite_energy(const Model& model, std::span<const double> x) {
  for (const double xi : x)
    if (!std::isfinite(xi)) throw InvalidInput("the initial positions or velocities are not finite");
  for (size_t body = 0; body < model.elasticity.size(); ++body) {
    if (std::isfinite(model.elasticity[body]->value(x))) continue;
    TetFields fields;
    fields.energy_density.resize(model.mesh.element_count());
    fields.det_F = fields.von_mises = fields.energy_density;
    fields.cauchy.resize(6 * fields.det_F.size());
    std::fill(fields.det_F.begin(), fields.det_F.end(), 1.0);
    model.elasticity[body]->evaluate(x, fields);
    std::vector<int> inverted;
    const BodyRange& range = model.bodies[body];
    for (int e = range.first_element(model.mesh); e < range.first_element(model.mesh) + range.element_count(); ++e)
      if (!(fields.det_F[e] > 0)) inverted.push_back(e);
    if (inverted.empty())
      throw InvalidInput(
          "the initial shape has infinite energy: its strain exceeds the range of the material; choose a "
          "smaller initial deformation or another material");
    if (range.is_sheet())
      throw BadInitialState(BadInitialState::Kind::collapsed_triangles,
                            "the initial shape has infinite energy: " + std::to_string(inverted.size()) +
                                " triangles are collapsed (" + listed(model.numbering.tet.to_user(inverted)) + ")",
                            "choose a smaller initial deformation");
    throw BadInitialState(BadInitialState::Kind::inverted_tets,
                          "the initial shape has infinite energy: " + std::to_string(inverted.size()) +
                              " tets are inverted or flat (" + listed(model.numbering.tet.to_user(inverted)) + ")",
                          "choose a material that tolerates inversion, or a smaller initial deformation");
  }
}

void require_apart(const Model& model, const State& start, const IntegratorFacts& integrator) {
  if (!model.contact) return;
  const std::vector<double>& x = start.q;
  const double time = start.time;
  if (!integrator.is_implicit || integrator.takes_one_iteration || integrator.ends_beyond_minimum)
    throw InvalidInput("contact needs an integrator that minimizes and ends at the minimum, not '" +
                       std::string(integrator.name) +
                       "'; choose backward_euler, bdf2 (order 2), or quasi_static for equilibria");
  const ContactMesh& contact = model.contact->mesh();
  Energy::Context at_start;
  at_start.time = time;
  const std::vector<Vec3d> points = model.contact->points(x, time);
  require_no_intersection(contact, points);
  require_before_planes(model, points);
  if (const int p = model.contact->self_touching_point(); p >= 0)
    throw BadInitialState(BadInitialState::Kind::touches_itself,
                          "body '" + contact.parts[contact.part[p]].name + "' touches itself at rest, at vertex " +
                              std::to_string(model.numbering.vertex.to_user(contact.row[p])),
                          "merge the coincident vertices or leave a gap");
  const double least_gap = 1e3 * std::numeric_limits<double>::epsilon() * max_abs(x);  // as in largest_step()
  const ContactSummary closest = model.contact->summary(x, time);
  if (closest.contacts > 0 && (!std::isfinite(model.contact->value(x, at_start)) || closest.min_gap < least_gap))
    throw InvalidInput("surfaces touch or overlap in the initial state: " + contact.parts[closest.parts[0]].name +
                       " and " + contact.parts[closest.parts[1]].name +
                       (closest.min_gap < 0 ? ", by " + three_digits(-closest.min_gap) + " m" : "") +
                       remedy_of_overlap(contact, closest.parts));
  require_outside(contact, points);
}

std::optional<SolverConflict> find_conflict(const SimulationOptions& options) {
  const std::unique_ptr<Integrator> integrator = make_integrator(options.integrator);
  const std::string name = "integrator = '" + options.integrator + "'";
  if (options.adaptive.tolerance > 0 && (integrator->facts().is_static() || integrator->facts().is_multistep))
    return SolverConflict{
        "adaptive", name + " does not support substeps: " +
                        (integrator->facts().is_static() ? "it is static" : "it needs a constant step length") + "; " +
                        joined(adaptive_integrator_names()) + " do"};
  const InitialGuess guess = initial_guess_named(options.initial_guess);
  const std::string chosen_guess = "initial_guess = '" + options.initial_guess + "'";
  if (guess != InitialGuess::best && !integrator->facts().chooses_guess())
    return SolverConflict{"initial_guess", chosen_guess + " has no effect on " + name + ": " +
                                               (integrator->facts().is_implicit ? "it starts from the current positions"
                                                                                : "it does not minimize")};
  if ((guess == InitialGuess::extrapolated || guess == InitialGuess::accelerated) && integrator->facts().is_static())
    return SolverConflict{"initial_guess",
                          chosen_guess + " needs velocities, but " + name + " has none; try 'last_increment'"};
  if (auto conflict = budget_conflict(options, *integrator)) return conflict;
  if (!integrator->facts().takes_one_iteration) return std::nullopt;
  const auto unfit = [&](const char* option, const std::string& method) {
    return SolverConflict{option, std::string(option) + " = '" + method + "' is not possible with " + name +
                                      ", which is one Newton iteration; choose newton or newton_cg"};
  };
  if (!estimates_minimizer(options.solver.method)) return unfit("method", options.solver.method);
  for (const std::string& method : options.solver.fallback)
    if (!estimates_minimizer(method)) return unfit("fallback", method);
  return std::nullopt;
}

void require_possible(const SimulationOptions& options) {
  const double tolerance = options.adaptive.tolerance;
  if (!(tolerance >= 0) || !std::isfinite(tolerance))
    throw InvalidInput("the tolerance of adaptive steps is " + three_digits(tolerance) +
                       "; it must be positive, or 0 for steps of one length");
  if (const auto conflict = find_conflict(options)) throw InvalidInput(conflict->reason);
}

}  // namespace aspic
