// The squared distances of markers between a measured and a simulated motion, as a function of motion parameters.
#pragma once
#include <span>
#include <string>
#include <vector>

#include "model/misfit.h"
#include "model/motion_parameters.h"
#include "optimize/objective.h"

namespace aspic {

struct MotionSample {
  int marker = 0;
  double time = 0;   // [s]
  Vec3d position{};  // [m]
  double sigma = 1;  // standard deviation of each coordinate [m]
};

struct MotionData {
  std::vector<SurfacePoint> markers;
  std::vector<Vec3d> offset;          // from the surface point to the marker, constant in the motion [m]
  std::vector<MotionSample> samples;  // after the start
  bool has_sigma = false;             // false: all are 1, and the noise is estimated from the residuals
};

// The objective at one p.
struct MotionPoint {
  bool ok = false;
  std::string message;  // diagnostic of a failed simulation
  std::vector<double> p;
  double value = 0;              // sum of |simulated - measured|^2 / (2 sigma^2)
  std::vector<double> gradient;  // with respect to p
  std::vector<Vec3d> simulated;  // marker position of each sample, linear in time between two steps [m]
  double rms = 0;                // root mean square distance over the samples [m]
};

class MotionObjective : public Objective, public HasPreconditioner {
 public:
  // The number of steps follows from the last sample. Throws InvalidInput as MotionParameters and Trajectory do.
  MotionObjective(MotionModel model, MotionData data, const std::vector<std::string>& names, TrajectoryOptions options);

  const MotionParameters& parameters() const { return parameters_; }
  const MotionData& data() const { return data_; }
  const StopToken& stop() const { return options_.stop; }
  int block_rows() const { return (parameters_.size() + 2) / 3; }
  double travel() const { return travel_; }          // root mean square displacement of the measured markers [m]
  double resting_value() const { return resting_; }  // value if no marker moved
  int simulations() const { return simulations_; }
  int gradients() const { return gradients_; }

  MotionPoint simulate(std::span<const double> p);       // without gradient
  MotionPoint differentiate(std::span<const double> p);  // value and gradient
  // Computes the preconditioner at a point: J'J, J by differences of simulations. Parameters that move no marker by
  // more than kSame of the travel per unit of p are held until the next call. Returns whether the set of held
  // ones changed.
  bool linearize(const MotionPoint& at);
  bool is_held(int i) const { return held_[i]; }
  void set_iterate(const MotionPoint& at) { at_ = trial_ = at; }
  const MotionPoint& iterate() const { return at_; }

  // x: p, padded with zeros to 3 numbers per block row.
  Evaluation evaluate(std::span<const double> x) override;
  Evaluation at_iterate() const;
  void gradient(std::span<const double> x, std::span<double> g) override;
  void note_iterate(std::span<const double> x) override;
  double max_step(std::span<const double> x, std::span<const double> d) override;
  bool precondition(std::span<const double> r, std::span<double> z) override;

 private:
  struct Place {  // place of a sample in time: between point `step` and the next one, with the weight of the latter
    int step = 0;
    double next = 0;
  };
  MotionPoint compute(std::span<const double> p, bool with_gradient);
  double visit(int point, const State& state, std::span<double> qbar, MotionPoint& result) const;
  void add(int sample, double weight, const State& state, std::span<double> qbar, MotionPoint& result) const;
  void finish(MotionPoint& result) const;
  bool is(std::span<const double> x, const MotionPoint& point) const;
  const BlockSparse& evaluate_hessian(std::span<const double>, const Projection&) override;

  MotionData data_;
  MotionParameters parameters_;
  TrajectoryOptions options_;
  std::vector<Place> places_;  // ascending, like the samples
  std::vector<int> first_;     // sample of each step, and the end
  double travel_ = 0, resting_ = 0;
  int simulations_ = 0, gradients_ = 0;
  MotionPoint at_, trial_;
  std::vector<bool> held_;
  std::vector<double> inverse_;  // inverse of J'J, row by row
};

}  // namespace aspic
