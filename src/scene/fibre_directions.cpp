#include "scene/fibre_directions.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/formatted.h"
#include "io/legacy_vtk.h"
#include "mesh/tet_shape.h"
#include "scene/harmonic_extension.h"
#include "scene/placement.h"
#include "scene/tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

using Directions = std::vector<FibreDirections>;
using Weights = std::array<double, 4>;  // barycentric coordinates of a point

// Calls direction_at(tet, weights) for each quadrature point. Directions of any length become unit vectors.
template <class DirectionAt>
Directions at_points(const FibreSource& source, const Place& place, const std::string& reason,
                     const DirectionAt& direction_at) {
  const TetMesh& mesh = source.body.mesh;
  Directions all(mesh.tets.size());
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int q = 0; q < fibre_point_count(mesh, t); ++q) {
      const Vec3d a = direction_at(t, fibre_point(mesh, t, q));
      const double length = norm(a);
      if (!(length > 0) || !std::isfinite(length)) {
        const Vec3d X = centroid(mesh, t);
        throw error_at(place, "fibres of body '" + source.body.name() + "' have no direction in tet " +
                                  std::to_string(t) + formatted(" at (%.3g, %.3g, %.3g) m: ", X[0], X[1], X[2]) +
                                  (reason.empty() ? "its length is " + number_text(length) : reason));
      }
      all[t][q] = (1 / length) * a;
    }
  return all;
}

template <class T>
T interpolated(const std::vector<T>& at, const Tet& tet, const Weights& w) {
  return (w[0] * at[tet[0]] + w[1] * at[tet[1]]) + (w[2] * at[tet[2]] + w[3] * at[tet[3]]);
}

// Vectors whose sign has no meaning.
Vec3d interpolated_axes(const std::array<Vec3d, 4>& at, const Weights& w) {
  Vec3d sum{};
  for (int i = 0; i < 4; ++i) sum = sum + (dot(at[0], at[i]) < 0 ? -w[i] : w[i]) * at[i];
  return sum;
}

Directions from_formulas(const FibreSource& source) {
  const Value& given = source.scene["direction"];
  const VectorField field(given);
  return at_points(source, given.place, "", [&](int t, const Weights& w) {
    return field.at(interpolated(source.body.mesh.rest, source.body.mesh.tets[t], w));
  });
}

// A harmonic field that is 0 and 1 at two places, without flux through the rest of the surface, and its gradient: the
// mean of the tets around each vertex.
struct Potential {
  std::vector<double> value;
  std::vector<Vec3d> gradient;
};

Potential potential_between(const FibreSource& source, Value& table, const char* low, const char* high) {
  const TetMesh& mesh = source.body.mesh;
  const auto selected = [&](const char* key) {
    Value& where = *table.table().find(key);
    return select_vertices(where, selection_scope(source.body, where, source.up));
  };
  Potential field{std::vector<double>(mesh.rest.size(), 0.0), std::vector<Vec3d>(mesh.rest.size(), Vec3d{})};
  std::vector<char> is_known(mesh.rest.size(), 0);
  for (const int v : selected(low)) is_known[v] = 1;
  for (const int v : selected(high)) {
    if (is_known[v])
      throw error_at(table[high].place, "vertex " + std::to_string(v) + " of body '" + source.body.name() +
                                            "' is in `" + low + "` and in `" + high +
                                            "`; fibres run between separate places");
    is_known[v] = 1;
    field.value[v] = 1;
  }
  try {
    HarmonicExtension(mesh, is_known).extend(field.value);
  } catch (const InvalidInput& e) {
    throw error_at(table[low].place, e.what());
  }
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const std::array<Vec3d, 4> gradients = shape_gradients(corners(mesh, t));
    Vec3d sum{};
    for (int i = 0; i < 4; ++i) sum = sum + field.value[mesh.tets[t][i]] * gradients[i];
    for (const int v : mesh.tets[t]) field.gradient[v] = field.gradient[v] + volume(mesh, t) * sum;
  }
  return field;
}

Directions from_flow(const FibreSource& source) {
  const Potential field = potential_between(source, source.scene, "from", "to");
  return at_points(source, source.scene["from"].place, "neither place reaches it",
                   [&](int t, const Weights& w) { return interpolated(field.gradient, source.body.mesh.tets[t], w); });
}

// The angle to the circumference changes from the inner to the outer surface [Bayer 2012].
Directions from_helix(const FibreSource& source) {
  Value& helix = *source.scene.table().find("helix");
  const Potential field = potential_between(source, helix, "inner", "outer");
  const double inner = helix["inner_angle_deg"].number(), outer = helix["outer_angle_deg"].number();
  const Vec3d axis = helix["axis"].vector();
  const std::string reason = "the helix axis is normal to the wall there, or neither surface reaches it";
  return at_points(source, helix.place, reason, [&](int t, const Weights& w) {
    const Tet& tet = source.body.mesh.tets[t];
    const Vec3d out = interpolated(field.gradient, tet, w), around = cross(axis, out), along = cross(out, around);
    const double share = interpolated(field.value, tet, w);
    const double angle = std::numbers::pi / 180 * (inner + (outer - inner) * share);
    return std::cos(angle) * ((1 / norm(around)) * around) + std::sin(angle) * ((1 / norm(along)) * along);
  });
}

// Three numbers per tet or per vertex.
struct VectorTable {
  std::vector<double> values;
  bool is_per_tet = true;

  Vec3d at(int i) const { return {{values[3 * i], values[3 * i + 1], values[3 * i + 2]}}; }
};

// The vertices of a linear mesh are the first ones of the quadratic mesh made from it.
bool fits_vertices(size_t count, const TetMesh& mesh) {
  if (count == mesh.rest.size()) return true;
  size_t corners = 0;
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) corners = std::max<size_t>(corners, v + 1);
  return count == corners;
}

VectorTable read_vtu_vectors(const fs::path& path, const Value& table, const TetMesh& mesh) {
  const Value* name = table.find("name");
  const Vtu vtu = read_vtk_or_vtu(path.string());
  std::vector<std::string> known;
  const std::string file = path.filename().string();
  const auto search = [&](const std::vector<Field>& fields) -> const Field* {
    const Field* found = nullptr;
    for (const Field& f : fields) {
      if (f.components != 3) continue;
      known.push_back(f.name);
      if (name && f.name == name->text()) found = &f;
    }
    return found;
  };
  const Field *cells = search(vtu.cell_fields), *points = search(vtu.point_fields);
  if (!name) throw error_at(table["file"].place, file + " needs `name`, its field of vectors" + suggestion("", known));
  if (!cells && !points)
    throw error_at(name->place, file + " has no field " + toml_string(name->text()) + " of three components" +
                                    suggestion(name->text(), known));
  const size_t count = (cells ? cells : points)->values.size() / 3;
  if (cells ? count != mesh.tets.size() : !fits_vertices(count, mesh))
    throw error_at(name->place, file + " has " + std::to_string(count) + (cells ? " cells" : " points") +
                                    "; the body has " + std::to_string(cells ? mesh.tets.size() : mesh.rest.size()) +
                                    (cells ? " tets" : " vertices"));
  return {(cells ? cells : points)->values, cells != nullptr};
}

Directions from_file(const FibreSource& source) {
  Value& given = *source.scene.table().find("directions");
  const TetMesh& mesh = source.body.mesh;
  const fs::path path = source.files.find(given["file"]);
  const bool is_vtu = is_vtk_or_vtu(path);
  if (const Value* name = given.find("name"); name && !is_vtu)
    throw error_at(name->place, "name = " + toml_string(name->text()) + "; only VTU files have named fields");
  const VectorTable table =
      is_vtu ? read_vtu_vectors(path, given, mesh)
             : VectorTable{read_number_table(path, 3, mesh.tets.size(), "a tet", given["file"].place)};
  check_fingerprint(given.table(), "hash", fingerprint_of_file(path), path.string());
  given.table().set("file", {source.files.keep(path, source.stem), {}});
  return at_points(source, given.place, "", [&](int t, const Weights& w) {
    if (table.is_per_tet) return table.at(t);
    std::array<Vec3d, 4> at;
    for (int i = 0; i < 4; ++i) at[i] = table.at(mesh.tets[t][i]);
    return interpolated_axes(at, w);
  });
}

}  // namespace

Directions fibre_directions(const FibreSource& source) {
  if (source.scene.find("direction")) return from_formulas(source);
  if (source.scene.find("helix")) return from_helix(source);
  if (source.scene.find("directions")) return from_file(source);
  return from_flow(source);
}

}  // namespace aspic
