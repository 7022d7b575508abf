// Barrier energy of contact [Li 2020; Li 2023]: V = sum of kappa w b(d) over points and the nearest features of the
// surfaces around them, where w is the area of a point. The constants are fixed during a run, so the energy is a
// function of the positions alone. A guard of shorter reach prevents edges from crossing.
#pragma once
#include <memory>

#include "contact/contact_laws.h"
#include "contact/contact_mesh.h"
#include "contact/contact_meter.h"
#include "contact/contact_stencil.h"
#include "contact/touches.h"
#include "energy/energy.h"

namespace aspic {

// Summary of the contacts at given positions.
struct ContactSummary {
  int contacts = 0;                                          // pairs closer than their reach
  double min_gap = std::numeric_limits<double>::infinity();  // smallest distance of any two surfaces below reach [m]
  std::array<int, 2> parts = {-1, -1};                       // the parts with this gap
  double reach = 0;                                          // reach of their features [m]
  double max_pressure = 0;                                   // [Pa]
  double widest_reach = 0;                                   // largest reach of these pairs [m]
  double gap_work = 0;                                       // sum of the contact forces times their gaps [J]
};

// The energy of contact and the pair of parts with the largest share of it.
struct ContactEnergy {
  double total = 0;                     // [J]
  std::array<int, 2> parts = {-1, -1};  // ascending
  double gap = 0;                       // smallest gap of these parts [m]
};

// A surface point that is closer to another surface than the reach.
struct ContactPoint {
  int row = -1;  // vertex of the model; -1: of an obstacle
  Vec3d position{};
  double gap = std::numeric_limits<double>::infinity();  // [m]
  double pressure = 0;                                   // [Pa]
};

class Barrier : public Energy, public StepLimitingEnergy, public StoppingEnergy {
 public:
  Barrier(ContactMesh mesh, const ContactOptions& options);
  ~Barrier() override;

  std::string_view name() const override { return "contact"; }
  // If obstacles advance along the next direction (StepContext::obstacle_end), the gradient includes the change of
  // forces by their motion to first order, and bounds of steps and stops include the motion.
  double value(Positions x, const Context& context) const override;
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override;
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override;
  // Returns a step of at most 1 along which no surfaces touch.
  double max_step(Positions x, const Context& context, std::span<const double> d) const override;
  // The same while obstacles move from their positions at time `from` to those at time `to` [s].
  double max_step(Positions x, std::span<const double> d, double from, double to) const;
  int add_stops(Positions x, const Context& context, std::span<const double> d,
                const ScaledModel& model) const override;

  const ContactMesh& mesh() const;
  ContactMeter& meter() const;  // of its cost, and that of friction
  const ContactLaws& laws() const;
  // Returns what separates surfaces that touch at x.
  std::vector<Touch> touches(Positions x, double time) const;
  // Returns a point whose distance to its own body at rest is zero; -1: none.
  int self_touching_point() const;
  // Returns one entry per point of the mesh. Empty if a position is not finite.
  std::vector<ContactPoint> contact_points(Positions x, double time) const;
  ContactSummary summary(Positions x, double time) const;
  ContactEnergy energy(Positions x, double time) const;
  bool has_moving_obstacle() const;
  // Returns pairs of moving obstacles and bodies, as "plate and ball", that would collide if obstacles moved and bodies
  // stayed at x.
  std::vector<std::string> blocked_parts(Positions x, double from, double to) const;

  // Returns the positions of the points of the mesh, with bodies at rest.
  std::vector<Vec3d> obstacle_points(double time) const;
  // Returns the positions of the points of the mesh. Throws InvalidInput if obstacles are not finite.
  std::vector<Vec3d> points(Positions x, double time) const;
  // Returns the displacement of the obstacle in a stencil, while obstacles move from the points `start` to `end`.
  Vec3d obstacle_displacement(const ContactStencil& stencil, std::span<const Vec3d> start,
                              std::span<const Vec3d> end) const;
  // Returns the stencils at x with a gap below their reach, in an order that depends on x alone.
  std::shared_ptr<const std::vector<ContactStencil>> stencils(Positions x, double time) const;
  // Returns the work [J] on the barrier of obstacles that move between two times, with their forces at x and the second
  // time.
  double obstacle_work(Positions x, double from, double to) const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic
