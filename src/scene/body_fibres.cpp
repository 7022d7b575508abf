#include "scene/body_fibres.h"

#include "base/formatted.h"
#include "energy/fibres.h"
#include "mesh/tet_shape.h"
#include "scene/harmonic_extension.h"
#include "scene/placement.h"
#include "scene/schema.h"
#include "scene/tables.h"

namespace aspic {
namespace {

struct BodyFibre {
  PlacedBody& body;
  Value& scene;
  std::string name;  // of the term
  const FibreScope& scope;

  std::vector<int> selected(const char* key) const {
    Value& where = *scene.table().find(key);
    return select_vertices(where, selection_scope(body, where, scope.up));
  }
};

// The potential is 0 at `from` and 1 at `to`, and no flux leaves the rest of the surface.
std::vector<Vec3d> flow(const BodyFibre& fibre) {
  const TetMesh& mesh = fibre.body.mesh;
  std::vector<char> is_given(mesh.rest.size(), 0);
  std::vector<double> potential(mesh.rest.size(), 0.0);
  for (const int v : fibre.selected("from")) is_given[v] = 1;
  for (const int v : fibre.selected("to")) {
    if (is_given[v])
      throw error_at(fibre.scene["to"].place, "vertex " + std::to_string(v) + " of body '" + fibre.body.name() +
                                                  "' is in `from` and in `to`; fibres run between separate places");
    is_given[v] = 1;
    potential[v] = 1;
  }
  try {
    HarmonicExtension(mesh, is_given).extend(potential);
  } catch (const InvalidInput& e) {
    throw error_at(fibre.scene["from"].place, e.what());
  }
  std::vector<Vec3d> directions(mesh.tets.size(), Vec3d{});
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3d, 4> gradients = shape_gradients(corners(mesh, t));
    for (int i = 0; i < 4; ++i) directions[t] = directions[t] + potential[mesh.tets[t][i]] * gradients[i];
  }
  return directions;
}

std::vector<Vec3d> given_directions(const BodyFibre& fibre) {
  const VectorField field(fibre.scene["direction"]);
  std::vector<Vec3d> directions;
  for (int t = 0; t < fibre.body.mesh.tet_count(); ++t) directions.push_back(field.at(centroid(fibre.body.mesh, t)));
  return directions;
}

// Unit vectors, one per tet of the user.
std::vector<Vec3d> directions_of(const BodyFibre& fibre) {
  const Value* direction = fibre.scene.find("direction");
  std::vector<Vec3d> directions = direction ? given_directions(fibre) : flow(fibre);
  for (size_t t = 0; t < directions.size(); ++t) {
    const double length = norm(directions[t]);
    if (!(length > 0) || !std::isfinite(length)) {
      const Vec3d X = centroid(fibre.body.mesh, static_cast<int>(t));
      throw error_at((direction ? *direction : fibre.scene["from"]).place,
                     "fibres of body '" + fibre.body.name() + "' have no direction in tet " + std::to_string(t) +
                         formatted(" at (%.3g, %.3g, %.3g) m", X[0], X[1], X[2]) +
                         (direction ? ": its length is " + number_text(length) : ": neither place reaches it"));
    }
    directions[t] = (1 / length) * directions[t];
  }
  return directions;
}

// Values of a key of a section, one per tet of the user.
std::vector<double> values(const BodyFibre& fibre, const char* section, const char* key) {
  PlacedBody& body = fibre.body;
  return tet_values(fibre.scene.table(), scene_schema().key(section, key),
                    {body.mesh, fibre.scope.files, body.name() + "." + fibre.name, *body.painted});
}

void add_fibre(const BodyFibre& fibre, Model& model) {
  const std::vector<Vec3d> directions = directions_of(fibre);
  const auto stiffness = values(fibre, "fibre", "stiffness"), exponent = values(fibre, "fibre", "exponent"),
             dispersion = values(fibre, "fibre", "dispersion");
  std::vector<Fibre> fibres(directions.size());
  for (int t = 0; t < fibre.body.mesh.tet_count(); ++t)
    fibres[fibre.body.numbering.tet.from_user(t)] = {directions[t], stiffness[t], exponent[t], dispersion[t]};
  model.loads.push_back(make_fibres(fibre.name, model.mesh, fibre.body.first_tet, fibres));
}

// Activations outside 0 to 1 throw InvalidInput, possibly long after the scene was read.
std::function<double(double)> activation_of(const Value& value) {
  const auto of_time = function_of_time(value, "activation: its formula may use only t");
  return [of_time, place = value.place](double time) {
    const double a = of_time(time);
    if (!(a >= 0 && a <= 1))
      throw error_at(place, "activation = " + number_text(a) + " at t = " + number_text(time) +
                                "; must be >= 0 and <= 1 (try min(1, max(0, ...)))");
    return a;
  };
}

void add_muscle(const BodyFibre& fibre, Model& model) {
  const std::vector<Vec3d> directions = directions_of(fibre);
  const auto strength = values(fibre, "muscle", "strength"), optimal = values(fibre, "muscle", "optimal_stretch");
  std::vector<MuscleFibre> fibres(directions.size());
  for (int t = 0; t < fibre.body.mesh.tet_count(); ++t)
    fibres[fibre.body.numbering.tet.from_user(t)] = {directions[t], strength[t], optimal[t]};
  model.loads.push_back(
      make_muscle(fibre.name, model.mesh, fibre.body.first_tet, fibres, activation_of(fibre.scene["activation"])));
}

}  // namespace

void add_fibres(std::vector<PlacedBody>& bodies, const FibreScope& scope, Model& model) {
  for (const std::string section : {"fibre", "muscle"}) {
    int number = 0;
    for (PlacedBody& body : bodies) {
      Value* list = body.scene.table().find(section);
      if (!list) continue;
      for (Value& scene : list->array()) {
        const std::string name = section + (++number == 1 ? "" : "_" + std::to_string(number));
        (section == "fibre" ? add_fibre : add_muscle)({body, scene, name, scope}, model);
      }
    }
  }
}

}  // namespace aspic
