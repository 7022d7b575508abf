// Fills a closed surface with tets, body by body in a frame of unit size, and compares the result with the surface.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/formatted.h"
#include "bodies.h"
#include "body_domain.h"
#include "fidelity.h"
#include "local_size.h"
#include "math/symmetric_eigen.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_mesh.h"
#include "mesher.h"
#include "sharp_edges.h"
#include "triangle_tree.h"
#include "unit_frame.h"

namespace aspic {
namespace {

// Flat bodies are stretched along their normal, so that refinement with equal edges gives correspondingly flat tets.
struct Stretch {
  Vec3d axis{};  // unit vector
  double factor = 1;
};

void stretch(const Stretch& stretch, std::vector<Vec3d>& points) {
  for (Vec3d& x : points) x = x + ((stretch.factor - 1) * dot(stretch.axis, x)) * stretch.axis;
}

// Returns the normal of a plate: a body whose surface mostly faces one direction or the opposite one.
// The eigenvalues of sum area n n' are the areas that face each of three directions.
std::optional<Vec3d> plate_normal(const TriMesh& body) {
  constexpr double kFacing = 0.95;  // fraction of the area
  std::array<double, 9> moment{};
  double whole = 0;
  for (int t = 0; t < body.triangle_count(); ++t) {
    const Vec3d n = unit_normal(body, t);
    const double part = area(body, t);
    whole += part;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) moment[i + 3 * j] += part * n[i] * n[j];
  }
  const SymmetricEigen<3> eigen = symmetric_eigen<3>(moment);
  const auto largest = std::max_element(eigen.values.begin(), eigen.values.end());
  if (!(*largest > kFacing * whole)) return {};
  const long k = 3 * (largest - eigen.values.begin());
  return Vec3d{{eigen.vectors[k], eigen.vectors[k + 1], eigen.vectors[k + 2]}};
}

// A body to refine, with its rule of edge lengths.
struct Plan {
  Stretch stretch;
  TriMesh surface;  // stretched
  double volume = 0;
  std::vector<SurfaceSample> samples;
  ThinParts thin;

  double thickness() const { return thin.thickness / stretch.factor; }
};

// Selects samples that are far enough apart to leave the refinement free.
std::vector<Vec3d> seeds(const std::vector<SurfaceSample>& samples) {
  constexpr size_t kSeeds = 200;
  std::vector<Vec3d> seeds;
  const size_t count = std::min(kSeeds, samples.size());
  for (size_t i = 0; i < count; ++i) seeds.push_back(samples[i * samples.size() / count].x);
  return seeds;
}

void append(const TetMesh& part, TetMesh& whole) {
  const int first = whole.vertex_count();
  whole.rest.insert(whole.rest.end(), part.rest.begin(), part.rest.end());
  for (const auto& [a, b, c, d] : part.tets) whole.tets.push_back({first + a, first + b, first + c, first + d});
}

class SurfaceFiller {
 public:
  SurfaceFiller(std::string name, const TriMesh& surface, const MesherOptions& options)
      : name_(std::move(name)), frame_(unit_frame(name_, surface.vertices)), options_(options) {
    TriMesh unit = surface;
    to_frame(frame_, unit.vertices);
    size_ = options.size > 0 ? options.size / frame_.unit : diagonal(unit.vertices) / 25;
    check_size(frame_.unit * extent(unit.vertices), frame_.unit * size_);
    bodies_ = bodies(unit);
  }

  FilledSurface fill() {
    for (size_t b = 0; b < bodies_.size(); ++b) append(filled(static_cast<int>(b)), result_.tets);
    from_frame(frame_, result_.tets.rest);
    if (least_ < 0.9 * size_)
      result_.notes.push_back("edges are as short as " + length(least_) + " where the shape is thin, and otherwise " +
                              length(size_));
    return std::move(result_);
  }

 private:
  std::string length(double in_frame) const { return three_digits(in_frame * frame_.unit); }

  std::string body_name(int body) const {
    return bodies_.size() == 1 ? name_
                               : name_ + ", body " + std::to_string(body + 1) + " of " + std::to_string(bodies_.size());
  }

  TetMesh filled(int body) {
    const Plan plan = cheapest(body);
    add_note(body, plan);
    TetMesh mesh;
    std::string problem = attempt(body, plan, 1, mesh);
    if (!problem.empty()) problem = attempt(body, plan, 0.6, mesh);
    if (!problem.empty()) problem = attempt(body, planned(body, {}, Sides::any), 1, mesh);
    if (problem.empty()) return mesh;
    throw InvalidInput(body_name(body) + ": " + problem_ + "; give a --size smaller than " + length(size_) +
                       ", or allow more than " + three_digits(options_.most_tets) + " tets with --max-tets");
  }

  // Returns why the tets do not represent the body; empty if they do.
  std::string attempt(int body, const Plan& plan, double factor, TetMesh& mesh) {
    if (!plan.thin.problem.empty()) return plan.thin.problem;
    SizeRule rule = plan.thin.rule;
    rule.size *= factor, rule.smallest *= factor, rule.tets_across /= factor;
    const double tets = predicted_tets(plan.samples, plan.volume, rule), allowed = 0.7 * size_;
    if (factor < 1 && tets > options_.most_tets) return "it needs too many tets";
    mesh = refined(plan, rule, tets);
    problem_ = mesh.tets.empty() ? "no tet fits into it"
                                 : mismatch(fidelity(bodies_[body], mesh, allowed), allowed, frame_.unit);
    if (problem_.empty()) least_ = std::min(least_, std::max(rule.smallest, least_size_));
    return problem_;
  }

  // Returns the plan with equal edges if it needs few enough tets; otherwise, for a plate, the least stretched plan.
  Plan cheapest(int body) const {
    Plan plan = planned(body, {}, Sides::opposite);
    const std::string problem = plan.thin.problem;
    const std::optional<Vec3d> normal = problem.empty() ? std::nullopt : plate_normal(bodies_[body]);
    for (const double factor : {2.0, 4.0, 8.0}) {
      if (plan.thin.problem.empty() || !normal) break;
      plan = planned(body, {*normal, factor}, Sides::opposite);
    }
    if (!plan.thin.problem.empty())
      throw InvalidInput(body_name(body) + ": it is " + length(plan.thickness()) + " thick, and " + problem +
                         "; increase --max-tets, or thicken it");
    return plan;
  }

  Plan planned(int body, const Stretch& along, Sides sides) const {
    Plan plan{along, bodies_[body], 0, {}, {}};
    stretch(along, plan.surface.vertices);
    plan.volume = std::abs(enclosed_volume(plan.surface));
    plan.samples = surface_samples(plan.surface, size_ / 2, sides);
    if (plan.samples.empty() || !(plan.volume > 0))
      throw InvalidInput(body_name(body) + ": encloses no volume; remove it");
    plan.thin = choose_rule(plan.samples, plan.volume, size_, options_.most_tets);
    return plan;
  }

  void add_note(int body, const Plan& plan) {
    const SizeRule& rule = plan.thin.rule;
    const double across = plan.thin.thickness / rule.smallest;
    const bool has_few = rule.smallest < size_ && across<1.9, is_flat = plan.stretch.factor> 1;
    if (!has_few && !is_flat) return;
    result_.notes.push_back(
        (bodies_.size() == 1 ? "" : "body " + std::to_string(body + 1) + ": ") + "it is " + length(plan.thickness()) +
        " thick; " + (has_few ? three_digits(across) + " tets across instead of two" : "") +
        (has_few && is_flat ? ", and " : "") +
        (is_flat ? "tets are " + three_digits(plan.stretch.factor) + " times as wide as thick" : "") +
        ", because more than " + three_digits(options_.most_tets) + " are not allowed (--max-tets)");
  }

  TetMesh refined(const Plan& plan, const SizeRule& rule, double predicted) {
    const LocalSize size(plan.samples, rule);
    least_size_ = size.least();
    BodyDomain domain{plan.surface, size, {}, seeds(plan.samples)};
    domain.has_blade = has_blade(plan.surface);
    if (options_.has_sharp_edges) domain.sharp = sharp_chains(plan.surface, rule.size);
    domain.most_vertices = static_cast<size_t>(1e4 + predicted);  // several times what refinement needs
    TetMesh mesh = fill_body(domain);
    stretch({plan.stretch.axis, 1 / plan.stretch.factor}, mesh.rest);
    return mesh;
  }

  std::string name_;
  UnitFrame frame_;
  const MesherOptions& options_;
  double size_ = 0;
  double least_ = Box::kInfinity, least_size_ = 0;  // edge lengths in the frame
  std::string problem_;                             // problem of the last mesh
  std::vector<TriMesh> bodies_;
  FilledSurface result_;
};

}  // namespace

FilledSurface mesh_surface(const std::string& name, const TriMesh& surface, const MesherOptions& options) {
  return SurfaceFiller(name, surface, options).fill();
}

}  // namespace aspic
