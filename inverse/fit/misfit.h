// What was measured against what a material predicts: r(p) = (predicted - measured) / standard deviation, over all load
// cases, with exact derivatives by tangents and adjoints of each equilibrium. The cases are solved in parallel; the
// bits do not depend on the number of threads.
#pragma once
#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "energy/probe.h"
#include "fit/equilibrium.h"
#include "fit/least_squares.h"
#include "fit/parameter_map.h"

namespace aspic {

// A point of the surface: a fixed combination of the corners of one triangle.
struct SurfacePoint {
  Triangle vertices{};
  std::array<double, 3> weights{};  // sum to 1
};

struct MarkerReading {
  int marker = 0;     // index into Experiment::markers
  Vec3d position{};   // measured [m]
  Vec3d deviation{};  // standard deviations [m], > 0
};

// Body, holds and loads stand still; positions of markers and, of a probe, force and torque were read.
struct LoadCase {
  std::string name;   // "poke 3, depth 2"
  std::string group;  // cases that are left out together: "poke 3"
  std::optional<Tip> tip;
  TipPose touch, pose;  // of the tip: at rest, and in this case
  Vec3d gravity{};      // [m/s^2]
  double pressure = 0;  // [Pa] over `pressed`
  std::vector<Triangle> pressed;
  std::vector<MarkerReading> positions;
  std::optional<Vec3d> force, torque;  // of the tip on the body, as measured [N, N m]
  Vec3d force_deviation{}, torque_deviation{};
};

struct Experiment {
  TetMesh mesh;                 // at rest, in the order of the fit
  std::vector<int> fixed;       // vertices that are held
  std::vector<double> density;  // one per tet [kg/m^3]
  std::vector<SurfacePoint> markers;
  std::vector<LoadCase> cases;  // of a group one after another, from the smallest load on
};

Vec3d at_rest(const Experiment& experiment, const SurfacePoint& point);

// What is predicted for one case.
struct CasePrediction {
  std::vector<double> x;       // of the vertices [m]
  std::vector<Vec3d> markers;  // one per entry of LoadCase::positions [m]
  Wrench wrench;
  MinimizeReport solve;
};

class Misfit : public LeastSquares {
 public:
  // Refers to both. The experiment's mesh is that of the map, or one where each of its tets is in the same number of
  // consecutive parts: a part has the material of its tet. Throws InvalidInput for a case that no residual comes from.
  Misfit(const Experiment& experiment, const ParameterMap& map, const EquilibriumOptions& options = {});
  ~Misfit() override;

  int unknowns() const override;
  int residual_count() const override;
  // Each case starts from the equilibrium of the last linearization, corrected by the tangent, or else from its last
  // one; when that fails, the load is applied in parts. The first time, each starts from the case before it in its
  // group.
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override;
  // A product that could not be computed is NaN; see failure().
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;
  // The logarithm of how stiff the layers of all tips are: stiffening them with the body moves nothing, so what the
  // residuals say along it is no knowledge of how stiff the body is.
  int nuisance_count() const override;
  void nuisance(int k, std::span<double> dr) override;
  std::vector<std::pair<int, int>> residuals_by_case() const override;

  // The equilibria of the last successful evaluate(), one case after another; empty before. A misfit that is given
  // them, evaluated and linearized at the same p continues to the same bits.
  std::vector<double> state() const;
  void set_state(std::span<const double> x);

  const CasePrediction& prediction(int c) const;  // by the last evaluate()
  std::pair<int, int> residuals_of(int c) const;  // first, count
  std::string what(int residual) const;           // "poke 3, depth 2: marker 17, y"
  // Why the last evaluate(), linearize() or product failed, in words.
  const std::string& failure() const;

  struct Counts {
    long equilibria = 0, newton_iterations = 0, factorizations = 0, solves = 0;
  };
  Counts counts() const;  // since the beginning

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
