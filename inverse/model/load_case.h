// One load case: a body at rest under its load, and its readings.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "indenter/probe_friction.h"
#include "model/misfit.h"
#include "model/scaled_load.h"
#include "model/systematic_errors.h"

namespace aspic {

// Pressure of a case with load.pressure != 0.
std::unique_ptr<Energy> make_pressure_of(const LoadCase& load, const TetMesh& mesh);

// Indenter of a case at its pose.
std::unique_ptr<Probe> make_probe_of(const Experiment& experiment, const LoadCase& load);

class LoadedBody {
 public:
  // Stores references to both. Throws InvalidInput for a case without residuals, or an invalid one.
  LoadedBody(const Experiment& experiment, const LoadCase& load, const std::string& material,
             std::span<const MaterialParameters> parameters, const EquilibriumOptions& options);

  int residual_count() const { return static_cast<int>(3 * (load_.positions.size() + has_force() + has_torque())); }
  std::string what(int residual) const;  // "poke 3, depth 2: marker 17, y"

  // Finds the equilibrium for these parameters: from `start`, then from the current positions, then by load stepping
  // from rest. Returns false if there is none; see failure().
  bool solve(std::span<const MaterialParameters> parameters, std::span<const double> start);
  bool is_solved() const { return is_solved_; }
  std::span<const double> x() const { return equilibrium_.x(); }
  void residuals(std::span<double> r) const;  // at x()
  const CasePrediction& prediction() const { return prediction_; }
  const std::string& failure() const { return failure_; }

  // Stores x() for linearize().
  void accept() { accepted_.assign(x().begin(), x().end()); }
  bool linearize(std::span<const MaterialParameters> parameters);
  std::span<const double> accepted() const { return accepted_; }
  void restore(std::span<const double> x);  // as if x had been found and accepted
  std::span<const double> linearized_x() const { return equilibrium_.linearized_x(); }  // empty: not linearized
  // Computes linearized x + dx/dtheta dtheta; false if the solve failed.
  bool predict(std::span<const double> dtheta, std::span<double> x);
  bool multiply(std::span<const double> dtheta, std::span<double> dr);
  bool add_transposed(std::span<const double> w, std::span<double> thetabar);
  void common_error(int k, std::span<double> dr) const;  // of LoadCase::common_errors, in standard deviations
  bool has_unknown_layer() const { return probe_ && !load_.layer_sigma; }
  bool multiply_by_layer(std::span<double> dr);     // dr/dlog k, k the stiffness of the indenter's layer
  bool multiply_by_friction(std::span<double> dr);  // dr/dlog mu, mu the coefficient of friction of the indenter
  bool multiply_by_rim(std::span<double> dr);       // dr/dlog rim of a sliding disc, without the change of its friction
  bool multiply_by_error(const SystematicError& error, std::span<double> dr);  // 0 if it does not concern the case

  const Misfit::Counts& counts() const { return counts_; }

 private:
  bool has_force() const { return load_.force.has_value(); }
  bool has_torque() const { return load_.torque.has_value(); }
  bool has_wrench() const { return has_force() || has_torque(); }
  static const LoadCase& readable(const Experiment& experiment, const LoadCase& load);  // throws if invalid
  Model make_model(const std::string& material, std::span<const MaterialParameters> parameters);
  void apply(double part);  // fraction of the load
  bool try_from(std::span<const double> start);
  bool load_in_parts();
  bool solved(const SolveReport& report);
  Wrench wrench();                                                            // at x()
  Wrench wrench_product(std::span<const double> dx) const;                    // of an indenter, linearized
  bool move_along_force(Wrench own, std::span<double> dr);                    // by -xbar_, which changes the wrench
  void store_wrench();                                                        // for derivatives by systematic errors
  Wrench wrench_change(std::span<const double> dtheta);                       // along dx_
  void add_wrench_transposed(const Wrench& bar, std::span<double> thetabar);  // to xbar_ and thetabar
  void put_change(const Wrench& change, std::span<double> dr) const;          // with dx_
  void put_change_of_reading(const SystematicError& error, std::span<double> dr) const;
  bool move_probe(const Twist& twist, Wrench& change);  // dx_ and the change of the wrench
  bool move_grip(const Twist& twist, Wrench& change);
  void predict_readings();

  const Experiment& experiment_;
  const LoadCase& load_;
  Probe* probe_ = nullptr;             // in the model; null without an indenter
  ProbeFriction* friction_ = nullptr;  // in the model; null without friction
  std::vector<ScaledLoad*> scaled_;    // weight and pressure in the model
  std::shared_ptr<GripMotion> grip_;   // in the model; null without a grip
  std::vector<double> rest_;
  Equilibrium equilibrium_;
  CasePrediction prediction_;
  std::vector<double> accepted_;
  bool is_solved_ = false;
  std::string failure_;
  Misfit::Counts counts_;
  Wrench linear_wrench_;                           // at the linearization
  std::vector<double> linear_force_;               // of a grip at the linearization; empty without systematic errors
  std::vector<double> dx_, xbar_, start_, force_;  // scratch
};

}  // namespace aspic
