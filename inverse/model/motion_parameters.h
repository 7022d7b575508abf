// The parameters of a motion: Young's modulus, Poisson's ratio, density, damping and rigid initial velocity of one
// body.
#pragma once
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "model/trajectory.h"

namespace aspic {

struct MotionValues {
  double young = 0, poisson = 0;         // mean over the volume [Pa], [1]
  double density = 0;                    // mean over the volume [kg/m^3]
  double mass_damping = 0;               // Rayleigh a of C = a M + b K [1/s]
  double stiffness_damping = 0;          // Rayleigh b [s]
  double viscosity = 0;                  // viscosity of strain-rate damping, mean over the volume [Pa s]
  Vec3d velocity{}, angular_velocity{};  // [m/s], [rad/s] about the center of mass
};

struct MotionModel {
  Model model;  // model of one body; its damping is replaced by that of the members below
  State start;  // with the velocities below
  double mass_damping = 0, stiffness_damping = 0;
  std::vector<double> viscosity = {};  // one per tet [Pa s]; empty: none
  Vec3d velocity{}, angular_velocity{};
};

// Characteristic sizes, for initial guesses and for the units of velocities.
struct MotionScales {
  double time_step = 0, duration = 0;  // [s]
  double speed = 0, size = 0;          // speed of the measured motion [m/s], size of the body [m]
};

struct MotionParameter {
  std::string name;  // "young", "velocity_x"
  std::string unit;  // "Pa"
  double guess = 0;
  std::string note = {};    // the reason for a guess that is not the value of the model
  bool can_vanish = false;  // a damping coefficient
};

// Parameters p, one number each, 0 at the guess. Positive quantities are guess * exp(p); a field of values per tet is
// scaled by one factor. Poisson's ratio is a logistic function of p. Velocities are guess + unit * p.
class MotionParameters {
 public:
  // `names`: of names(). Throws InvalidInput for an unknown name and for a quantity that the model cannot vary.
  MotionParameters(MotionModel model, const std::vector<std::string>& names, const MotionScales& scales);

  static std::vector<std::string> names();  // "young", ..., "velocity", "angular_velocity": three parameters each

  int size() const { return static_cast<int>(parameters_.size()); }
  const std::vector<MotionParameter>& parameters() const { return parameters_; }
  double value(int i, double p) const;  // value of a parameter, in its unit
  double slope(int i, double p) const;  // dvalue/dp
  MotionValues values(std::span<const double> p) const;
  std::vector<MaterialParameters> material(std::span<const double> p) const;  // one per tet
  std::vector<double> density(std::span<const double> p) const;               // one per tet [kg/m^3]
  std::vector<double> viscosity(std::span<const double> p) const;             // one per tet [Pa s]

  const Model& model() const { return model_.model; }
  const State& start() const { return model_.start; }
  // Returns the motion for p. It holds the model until take_back().
  Trajectory trajectory(std::span<const double> p, const TrajectoryOptions& options);
  void take_back(Trajectory&& trajectory) { model_.model = std::move(trajectory).release_model(); }
  // Returns the derivatives with respect to p, from the gradient of a trajectory for p.
  std::vector<double> derivatives(std::span<const double> p, const TrajectoryGradient& gradient) const;

 private:
  enum class Kind { young, poisson, density, mass_damping, stiffness_damping, viscosity, velocity, angular_velocity };
  struct Named {
    Kind kind;
    const char *name, *unit;
  };
  struct Entry {
    Kind kind;
    int axis = 0;     // axis of a velocity
    double unit = 1;  // unit of p, for a velocity
  };
  static std::span<const Named> named();
  void add(const std::string& name, const MotionScales& scales);
  void add_poisson(const MotionParameter& parameter);
  void add_positive(Kind kind, const MotionParameter& parameter);
  void add_vector(Kind kind, const MotionParameter& parameter, const Vec3d& guess, double unit);
  std::optional<double> fitted(Kind kind, std::span<const double> p) const;
  Vec3d vector(Kind kind, std::span<const double> p, const Vec3d& fallback) const;
  double factor(Kind kind, std::span<const double> p) const;  // exp(p); 1 if the quantity is not fitted
  void set_density(const std::vector<double>& density);
  void set_damping(std::span<const double> p);
  State start(std::span<const double> p) const;
  double derivative(const Entry& entry, double slope, std::span<const double> p, const TrajectoryGradient& g) const;
  double material_derivative(const Entry& entry, double slope, std::span<const double> p,
                             const TrajectoryGradient& g) const;
  Vec3d arm(int vertex) const;  // from the center of mass, at the start

  MotionModel model_;
  std::vector<MaterialParameters> material_;
  std::vector<double> density_, volume_;
  std::optional<Vec3d> gravity_;
  Vec3d center_{};  // center of mass
  std::vector<Entry> entries_;
  std::vector<MotionParameter> parameters_;
};

}  // namespace aspic
