// Misfit between measurements and predictions: r(p) = (predicted - measured) / standard deviation over all load cases,
// with exact derivatives by tangents and adjoints of each equilibrium. Cases are solved in parallel, bit-reproducibly
// for any number of threads.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "indenter/probe.h"
#include "model/equilibrium.h"
#include "model/grip.h"
#include "model/least_squares.h"
#include "model/parameter_map.h"
#include "model/systematic_error.h"

namespace aspic {

// Surface point: a fixed combination of the corners of one triangle.
struct SurfacePoint {
  Triangle vertices{};
  std::array<double, 3> weights{};  // sum to 1
};

struct MarkerReading {
  int marker = 0;           // index into Experiment::markers
  Vec3d position{};         // measured [m]
  Vec3d sigma{};            // standard deviations [m], > 0
  bool is_outlier = false;  // not compared with predictions of held-out cases
};

// Errors of all readings of a case that one standard normal factor multiplies, the same in all cases.
struct CommonError {
  std::string cause;           // "the mesh"
  std::vector<Vec3d> markers;  // one per position [m]
  Wrench wrench;
};

// A static state: body, supports and loads are at rest; measured are marker positions and, with an indenter or a grip,
// its force and torque.
struct LoadCase {
  std::string name;          // "poke 3, depth 2"
  std::string group;         // cases that are held out together: "poke 3"
  std::string session, tip;  // with common systematic errors of instruments and of the layer
  std::optional<Indenter> indenter;
  std::optional<double> layer_sigma;  // standard deviation of the logarithm of the layer's stiffness; empty: unknown
  double friction_sigma = 0;          // standard deviation of the logarithm of the indenter's friction; 0: known
  double rim_sigma = 0;               // standard deviation of the logarithm of the rim of a disc; 0: known
  IndenterPose touch, pose;           // pose of the indenter: at rest, and in this case
  std::optional<Grip> grip;           // excludes an indenter
  Vec3d gravity{};                    // [m/s^2]
  double pressure = 0;                // [Pa] over `pressed`: a follower pressure, or a dead load
  bool is_dead_pressure = false;
  std::vector<Triangle> pressed;
  std::vector<MarkerReading> positions;
  int merged = 0;                      // number of measured coordinates that condensed() removed from `positions`
  std::optional<Vec3d> force, torque;  // measured, on the body [N, N m]
  Vec3d force_sigma{}, torque_sigma{};
  std::vector<CommonError> common_errors;    // equally many in all cases
  std::optional<Vec3d> gauge, torque_gauge;  // the only axes along which force and torque were measured
  // Correction of the pose for systematic errors: rotation vector [rad], and direction of backlash.
  Vec3d turned{}, backward{};
};

// A vertex of a refined mesh in the middle of an edge, in a body without loads.
struct Midpoint {
  int vertex, a, b;
};

struct Experiment {
  TetMesh mesh;                     // at rest, in the order of the fit
  std::vector<int> parent;          // of a refined mesh: tet of the material's mesh, for each tet; empty: the same mesh
  std::vector<Midpoint> midpoints;  // of a refined mesh: corners that the mesh of the data lacks, after a and b
  std::vector<int> fixed;           // held vertices
  std::vector<double> density;      // one per tet [kg/m^3]
  std::vector<SurfacePoint> markers;
  std::vector<Vec3d> marker_offset;  // of an unloaded scan: distance of each marker from its surface point; empty: 0
  std::vector<LoadCase> cases;       // group by group, each from the smallest load on
  std::vector<SystematicError> errors;
  // Acceleration of gravity when the mesh was scanned [m/s^2]; empty: the mesh is unloaded (unloaded_shape.h).
  std::optional<Vec3d> scan_gravity;
};

// What an experiment contains, as types. Functions that accept any of them accept an Experiment.
struct Measured : Experiment {};   // a data set, on its mesh
struct OnMesh : Experiment {};     // the same on the mesh that is simulated
struct Corrected : Experiment {};  // actual loads, and readings without estimated errors
// Few readings per triangle in place of many, see condensed(). Only squares of their residuals have a meaning.
struct Condensed : Experiment {};

// Returns the cases for which `wanted` is true, with the same body.
template <class T, class Wanted>
T subset(T experiment, const Wanted& wanted) {
  std::erase_if(experiment.cases, [&](const LoadCase& c) { return !wanted(c); });
  return experiment;
}

// Parameters of each tet of the experiment's mesh, from those of each tet of the material's mesh.
std::vector<MaterialParameters> of_tets(const Experiment& experiment, std::span<const MaterialParameters> parameters);

Vec3d at_rest(const Experiment& experiment, const SurfacePoint& point);

// Prediction for one case.
struct CasePrediction {
  std::vector<double> x;       // vertex positions [m]
  std::vector<Vec3d> markers;  // one per entry of LoadCase::positions [m]
  Wrench wrench;
  MinimizeReport solve;
};

class Misfit : public LeastSquares {
 public:
  // Stores references to both. The experiment's mesh is that of the map, or a refinement of it. A scanned mesh is
  // unloaded for each p; J includes the change of its shape by differences, so at most kMaxUnloaded parameters are
  // accepted. Throws InvalidInput for a case without residuals.
  static constexpr int kMaxUnloaded = 20;  // chosen: each costs two unloadings per iteration
  Misfit(const Experiment& experiment, const ParameterMap& map, const EquilibriumOptions& options = {});
  ~Misfit() override;

  int parameter_count() const override;
  int residual_count() const override;
  int reading_count() const override;
  // Restricts evaluations, linearizations and products to these cases; the residuals of all others are 0.
  void use_cases(const std::function<bool(const LoadCase&)>& wanted);
  // Each case starts from the equilibrium of the last linearization, corrected by the tangent, or from its last one; on
  // failure by load stepping. The first time, each starts from the previous case of its group.
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;  // does nothing where J is known
  // Products that cannot be computed are NaN; see failure().
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  // The systematic errors of the experiment, its common errors, and at last the logarithm of the stiffness of all
  // layers that is unknown: scaling it with the body changes no positions, so residuals along it do not determine the
  // stiffness of the body.
  int nuisance_count() const override;
  NuisancePrior nuisance_prior(int k) const override;
  void nuisance(int k, std::span<double> dr) override;
  std::vector<std::pair<int, int>> residuals_by_case() const override;

  // Equilibria of the last successful evaluate(), case by case; empty before. A misfit with this state, evaluated and
  // linearized at the same p, continues bit-reproducibly. Keeps J of the same equilibria.
  std::vector<double> state() const;
  void set_state(std::span<const double> x);

  const CasePrediction& prediction(int c) const;  // from the last evaluate()
  std::pair<int, int> residuals_of(int c) const;  // first, count
  std::string what(int residual) const;           // "poke 3, depth 2: marker 17, y"
  // Message of the last failed evaluate(), linearize() or product.
  const std::string& failure() const;

  struct Counts {
    long equilibria = 0, newton_iterations = 0, factorizations = 0, solves = 0;
  };
  Counts counts() const;  // totals since construction

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
