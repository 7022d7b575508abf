// Builds the model of one body step by step:
//   Model model = ModelBuilder(make_box({0, 0, 0}, {0.1, 0.1, 0.1}, {4, 4, 4}))
//                     .material("neo_hookean", {.young = 5e3, .poisson = 0.4})
//                     .density(1000)
//                     .gravity({0, -9.81, 0})
//                     .pin("top", [](const Vec3d& X) { return X[1] == 0.1; })
//                     .build();
// All functions throw InvalidInput for invalid values, such as a negative density, an unknown material or a predicate
// that selects no vertex. Pins and loads keep the order of the calls; gravity is the first load.
#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "dynamics/model.h"
#include "dynamics/pressure_load.h"
#include "mesh/vertices.h"

namespace aspic {

// A homogeneous material: small-strain constants, and any further parameters in the order of MaterialInfo::extra. An
// empty list selects the defaults.
struct ElasticConstants {
  double young = 0;                // Young's modulus [Pa], > 0
  double poisson = 0;              // Poisson's ratio, between -1 and 0.5
  std::vector<double> extra = {};  // units: see MaterialInfo
};

// Returns the parameters of one tet. Throws InvalidInput if the constants are invalid for the material.
MaterialParameters material_parameters(const std::string& material, const ElasticConstants& constants);

class ModelBuilder {
 public:
  // `body`: name of the body in reports. Throws InvalidInput if a tet has no positive volume.
  explicit ModelBuilder(TetMesh mesh, std::string body = "body");

  // Sets the same material in every tet, by name; see materials(). One of the three overloads is required.
  ModelBuilder& material(const std::string& name, const ElasticConstants& constants);
  // Sets one parameter set per tet.
  ModelBuilder& material(const std::string& name, std::span<const MaterialParameters> parameters);
  // Sets a material that is not in the registry; see custom_material().
  ModelBuilder& material(ElasticityMaker maker, const MaterialParameters& parameters);

  ModelBuilder& density(double density);                 // [kg/m^3], >= 0; required
  ModelBuilder& density(std::vector<double> densities);  // one per tet
  ModelBuilder& mass(MassKind kind);                     // default: consistent

  ModelBuilder& gravity(const Vec3d& acceleration);  // [m/s^2]; default: no such load

  // Dirichlet conditions: the vertices are fixed at the start or, with a motion, follow x(t) = motion(x at the start,
  // t). With `directions` (orthonormal), only the displacements along these are prescribed.
  ModelBuilder& pin(std::string name, const Predicate& where, Motion motion = {}, std::vector<Vec3d> directions = {});
  ModelBuilder& pin(std::string name, std::vector<int> vertices, Motion motion = {},
                    std::vector<Vec3d> directions = {});

  // Adds a spring from each selected vertex to its target: its rest position or, with a motion, motion(X, t).
  // `stiffness`: of each spring [N/m].
  ModelBuilder& springs(std::string name, const Predicate& where, double stiffness, const Motion& motion = {});

  // Adds a follower pressure on boundary faces, see dynamics/pressure_load.h; after the other loads.
  ModelBuilder& pressure(std::string name, std::vector<Face> patch, std::function<double(double time)> value);

  // Adds any other term of V.
  ModelBuilder& load(std::unique_ptr<Energy> term);

  // Adds damping forces -(a M + b K) v. Units: a [1/s], b [s].
  ModelBuilder& rayleigh_damping(double mass_factor, double stiffness_factor);
  // Adds a viscous stress eta dE/dt in every tet. Units: eta [Pa s].
  ModelBuilder& strain_rate_damping(double viscosity);
  // Adds a Maxwell branch in every tet, see energy/maxwell_branches.h. Units: G [Pa], relaxation time [s].
  ModelBuilder& maxwell_branch(double shear, double relaxation_time);

  // Returns the model; the builder is empty afterwards. Throws InvalidInput if material or density are missing.
  Model build();

 private:
  int tet_count() const { return model_.mesh.tet_count(); }
  std::vector<int> vertices_for(const std::string& user, const Predicate& where) const;

  Model model_;  // contains mesh, density, pins and loads
  ElasticityMaker make_elasticity_;
  std::vector<MaterialParameters> parameters_;
  MassKind mass_kind_ = MassKind::consistent;
  std::optional<Vec3d> gravity_;
  std::vector<PressureLoad> pressures_;
  std::optional<std::pair<double, double>> rayleigh_;  // a, b
  std::optional<double> viscosity_;
  std::vector<std::pair<double, double>> branches_;  // G, relaxation time
};

// Returns the vertex forces mass * acceleration, 3 per vertex [N].
std::vector<double> weights(const MassMatrix& mass, const Vec3d& acceleration);

}  // namespace aspic
