#include "scene/body_sheet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "dynamics/integrator.h"
#include "energy/sheet_elasticity.h"
#include "energy/wind.h"
#include "io/mesh_file.h"
#include "math/svd3.h"
#include "mesh/box.h"
#include "mesh/close_corners.h"
#include "mesh/elements.h"
#include "mesh/sheet_shapes.h"
#include "mesh/surface.h"
#include "mesh/topology.h"
#include "mesh/triangle_shape.h"
#include "scene/placement.h"
#include "scene/schema.h"
#include "scene/thin_body.h"

namespace aspic {
namespace {

constexpr double kAcross = 1e-6;  // least sine between the warp and the normal of a triangle
constexpr double kFastest = 1e4;  // speed of wind [m/s]
constexpr double kThick = 0.1;    // thickness relative to the extent, above which a body is no sheet

std::string list_of(const std::vector<int>& triangles) {
  std::string text;
  for (size_t i = 0; i < std::min<size_t>(triangles.size(), 5); ++i)
    text += (i ? ", " : " (") + std::to_string(triangles[i]);
  return text + (triangles.size() > 5 ? ", ...)" : ")");
}

// Throws InvalidInput for triangles that have no shape, and for vertices of no triangle.
void check(const TriMesh& mesh, const Value& body, const Place& place) {
  const std::string which = "body '" + body["name"].text() + "': ";
  if (mesh.triangles.empty()) throw error_at(place, which + "the mesh has no triangles");
  std::vector<int> flat;
  std::vector<char> is_used(mesh.vertices.size(), 0);
  for (int t = 0; t < mesh.triangle_count(); ++t) {
    const auto& [a, b, c] = mesh.triangles[t];
    for (const int v : mesh.triangles[t]) is_used[v] = 1;
    if (lists_vertex_twice(mesh.triangles[t]) || is_degenerate({mesh.vertices[a], mesh.vertices[b], mesh.vertices[c]}))
      flat.push_back(t);
  }
  if (!flat.empty())
    throw error_at(place, which + std::to_string(flat.size()) + " triangles have no area" + list_of(flat) +
                              "; flip or collapse their edges in the source model");
  if (const std::vector<int> repeated = repeated_elements(mesh.triangles); !repeated.empty())
    throw error_at(place, which + std::to_string(repeated.size()) + " triangles have the vertices of an earlier one" +
                              list_of(repeated) + "; remove them, or run aspic check MESH --repair -o MENDED");
  if (const auto unused = std::count(is_used.begin(), is_used.end(), 0); unused > 0)
    throw error_at(place, which + std::to_string(unused) +
                              " vertices belong to no triangle; remove them (aspic check MESH --repair -o MENDED)");
}

StretchLimit limit_of(const Value& shell, double young) {
  const Value* limit = shell.find("limit");
  if (!limit) return {};
  const Value& to = limit->is_number() ? *limit : (*limit)["to"];
  const Value* from = limit->is_number() ? nullptr : limit->find("from");
  if (!(to.number() > 1))
    throw error_at(to.place, "limit = " + number_text(to.number()) +
                                 "; the largest stretch must be above 1 (try 1.1 for at most 10 %)");
  if (from && !(from->number() >= 1 && from->number() < to.number()))
    throw error_at(from->place, "from = " + number_text(from->number()) + "; must be at least 1 and below to = " +
                                    number_text(to.number()) + " (remove it for the mean of 1 and to)");
  return {from ? from->number() : 0.5 * (1 + to.number()), to.number(), young};
}

// Throws InvalidInput if a triangle is stretched beyond the limit at the start.
void check_limit(const PlacedBody& body, const StretchLimit& limit, const Model& model) {
  std::vector<double> x(3 * model.mesh.rest.size());
  for (size_t v = 0; v < body.start.size(); ++v)
    for (int r = 0; r < 3; ++r)
      x[3 * static_cast<size_t>(body.model_vertex(static_cast<int>(v))) + r] = body.start[v][r];
  for (size_t t = 0; t < body.mesh.sheet.size(); ++t) {
    const int element = model.mesh.tet_count() + body.first_triangle + static_cast<int>(t);
    const Mat3d F = deformation_gradient(model.mesh, element, x);
    if (const double s = svd3(F).s[0]; !(s < limit.to))
      throw error_at(body.scene["shell"]["limit"].place,
                     "limit: triangle " + std::to_string(t) + " of body '" + body.name() + "' is stretched by " +
                         three_digits(s) + " at the start; the limit is " + number_text(limit.to) +
                         " (choose a higher limit, a larger pattern, or a smaller deformation)");
  }
}

MembraneLaw law_of(const PlacedBody& body, const TetMesh& mesh, size_t t, const MaterialParameters& parameters) {
  const Value& shell = body.scene["shell"];
  const double E = young_modulus(parameters.lame), nu = poisson_ratio(parameters.lame);
  const double thickness = shell["thickness"].number();
  const Value* weave = shell.find("weave");
  if (!weave) return IsotropicSheet{E, nu, thickness, limit_of(shell, E)};
  const double weft = (*weave)["weft"].number();
  if (!(nu * nu * weft < E))
    throw error_at((*weave)["weft"].place,
                   "weft = " + number_text(weft) + "; must be below young / poisson^2 = " + number_text(E / (nu * nu)));
  const std::array<Vec3d, 3> X = rest_corners(mesh, body.first_triangle + static_cast<int>(t));
  const Value& along = (*weave)["warp"];
  if (const Vec3d n = cross(X[1] - X[0], X[2] - X[0]), d = along.vector();
      !(norm(cross(n, d)) > kAcross * norm(n) * norm(d)))
    throw error_at(along.place, "warp is normal to triangle " + std::to_string(t) + " of body '" + body.name() +
                                    "'; give a direction along the sheet");
  const PlaneVector warp = direction_in_plane(X, along.vector());
  return OrthotropicSheet{E, weft, nu, (*weave)["shear"].number(), thickness, warp, limit_of(shell, E)};
}

double area_of(const TriangleCorners& X) { return 0.5 * norm(cross(X[1] - X[0], X[2] - X[0])); }

// Gives the sheet the rest shapes of texture coordinates, and notes how their areas differ from those of the mesh.
void add_pattern(const Value& body, std::vector<TriangleCorners> uv, TetMesh& mesh, std::vector<std::string>& notes) {
  const double scale = body["shell"]["pattern"]["uv_scale"].number();
  double of_mesh = 0, of_pattern = 0, least = INFINITY, largest = 0;
  for (size_t t = 0; t < uv.size(); ++t) {
    for (Vec3d& corner : uv[t]) corner = scale * corner;
    const double flat = area_of(uv[t]), given = area_of(rest_corners(mesh, static_cast<int>(t)));
    of_mesh += given, of_pattern += flat;
    least = std::min(least, flat / given), largest = std::max(largest, flat / given);
  }
  mesh.pattern = std::move(uv);
  notes.push_back("body '" + body["name"].text() + "': the pattern has " + three_digits(of_pattern / of_mesh) +
                  " of the area of the mesh, its triangles " + three_digits(least) + " to " + three_digits(largest) +
                  " (uv_scale = " + three_digits(scale * std::sqrt(of_mesh / of_pattern)) + " keeps the area)");
}

double moment_of(const Value& shell, const MaterialParameters& parameters) {
  if (const Value* moment = shell.find("moment")) return moment->number();
  const double E = young_modulus(parameters.lame), nu = poisson_ratio(parameters.lame);
  return E * std::pow(shell["thickness"].number(), 3) / (12 * (1 - nu * nu));
}

// Rejects edges of three or more triangles and sheets without bending stiffness.
void require_mid_edges(const PlacedBody& body, const std::vector<Triangle>& triangles) {
  const Value& shell = body.scene["shell"];
  if (const Value* moment = shell.find("moment"); moment && moment->number() == 0)
    throw error_at(moment->place, "moment = 0; bending = \"mid_edge\" needs a positive one (or choose \"hinge\")");
  const std::vector<EdgeUse> uses = edge_uses(triangles);
  for_each_edge(uses, [&](const EdgeUse* first, const EdgeUse* last) {
    if (last - first > 2)
      throw error_at(shell["bending"].place, "bending = \"mid_edge\": body '" + body.name() + "' has an edge of " +
                                                 std::to_string(last - first) +
                                                 " triangles, and two are possible (choose \"hinge\")");
  });
}

// Adds the bending of hinges that yield, and leaves it out of the sheet.
void add_creases(const PlacedBody& body, Model& model, SheetMaterial& sheet) {
  const Value& shell = body.scene["shell"];
  const Value& yield = shell["yield"];
  if (shell["bending"].text() == "mid_edge")
    throw error_at(yield.place, "yield needs bending = \"hinge\" (remove one of the two)");
  if (*std::max_element(sheet.moment.begin(), sheet.moment.end()) == 0)
    throw error_at(yield.place, "yield = " + number_text(yield.number()) +
                                    ", but the bending stiffness is 0 (remove it, or set a positive moment)");
  sheet.bends = false;
  const auto number = std::count_if(model.damping.begin(), model.damping.end(),
                                    [](const auto& term) { return term->name().starts_with("creases"); });
  model.damping.push_back(make_creases(number ? "creases_" + std::to_string(number + 1) : "creases",
                                       {model.mesh, body.first_triangle, sheet.moment, sheet.rest, yield.number()}));
}

// Adds the plates of mid-edge bending to the sheet, and its angles to the model. `moment` replaces the stiffness along
// direction 1, and scales the others.
void add_mid_edges(const PlacedBody& body, const BodyMaterial& material, Model& model, SheetMaterial& sheet) {
  const auto first = model.mesh.sheet.begin() + body.first_triangle;
  const std::vector<Triangle> triangles(first, first + static_cast<std::ptrdiff_t>(sheet.laws.size()));
  require_mid_edges(body, triangles);
  const bool has_moment = body.scene["shell"].find("moment") != nullptr;
  const double thickness = body.scene["shell"]["thickness"].number();
  std::vector<double> mass;
  for (size_t t = 0; t < triangles.size(); ++t) {
    PlateStiffness& plate = sheet.plates.emplace_back(plate_stiffness(sheet.laws[t]));
    const double scale = has_moment ? sheet.moment[t] / plate.D11 : 1;
    for (double* D : {&plate.D11, &plate.D22, &plate.D12, &plate.D33}) *D *= scale;
    mass.push_back(material.density[t] * std::pow(thickness, 3) / 12);
  }
  sheet.first_angle_row = model.rows();
  for (const AngleRow& row : make_angle_rows(model.mesh.rest, triangles, mass)) model.angle_rows.push_back(row);
}

std::string direction_text(const Vec3d& n) {
  std::string text;
  for (const double component : n.a)
    text += (text.empty() ? "[" : ", ") + number_text(std::round(1e3 * component) / 1e3 + 0.0);  // no "-0"
  return text + "]";
}

struct Surroundings {
  WindField wind;
  Vec3d gravity;
  double duration;  // of the run [s]
};

// Returns the normal of a flat sheet if neither gravity nor wind, sampled over the run, pushes the sheet along it.
std::optional<Vec3d> normal_across_wind(const PlacedBody& body, const Surroundings& air) {
  constexpr double kParallel = 1e-9;  // sine of an angle that only round-off causes
  const std::vector<Vec3d>& x = body.start;
  std::optional<Vec3d> normal;
  double fastest = 0;
  for (const Triangle& t : body.mesh.sheet) {
    const Vec3d N = cross(x[t[1]] - x[t[0]], x[t[2]] - x[t[0]]), n = (1 / norm(N)) * N;
    if (!normal) normal = n;
    if (!(norm(cross(*normal, n)) < kParallel)) return std::nullopt;
    for (int k = 0; k < 8; ++k) {
      const Vec3d u = air.wind((1.0 / 3) * (x[t[0]] + x[t[1]] + x[t[2]]), air.duration * k / 7.3);
      if (std::abs(dot(u, *normal)) > kParallel * norm(u)) return std::nullopt;
      fastest = std::max(fastest, norm(u));
    }
  }
  const bool falls = normal && std::abs(dot(air.gravity, *normal)) > kParallel * norm(air.gravity);
  return fastest > 0 && !falls ? normal : std::nullopt;
}

}  // namespace

BodyMesh make_sheet_mesh(Value& body, MeshLoader& loader) {
  refuse_keys_of_solids(body, {"shell", "a shell is neo_hookean, or has shell.weave", {}, {"viscosity"}});
  const Value* shape = body.find("shape");
  const Place place = (shape ? *shape : body["mesh"]).place;
  const Value* pattern = body["shell"].find("pattern");
  if (shape && pattern)
    throw error_at(pattern->place, "pattern: a shape has no texture coordinates (give an OBJ file as `mesh`)");
  std::vector<TriangleCorners> uv;
  std::vector<TriangleUv> texture;
  bool is_solid = shape && !shape->find("rectangle") && !shape->find("disc") && !shape->find("tube");
  const auto read = [&](const std::string& path) {
    if (pattern) uv = read_uv(path);
    auto mesh = read_mesh(path);
    is_solid = std::holds_alternative<TetMesh>(mesh);
    if (is_solid) return boundary_surface(std::get<TetMesh>(mesh)).surface;
    texture = read_texture(path, std::get<TriMesh>(mesh).triangle_count(), loader.notes);
    return std::get<TriMesh>(std::move(mesh));
  };
  TriMesh surface = shape ? shape_surface(*shape, loader) : thin_mesh_from_file(body, loader, read);
  check(surface, body, place);
  if (is_solid)
    loader.notes.push_back("body '" + body["name"].text() +
                           "': its shell is the surface of a solid, and hollow (remove shell to fill it)");
  if (const std::string why = loader.why_not(surface.triangle_count()); !why.empty())
    throw error_at(body.place, why + " (choose a coarser mesh)");
  loader.tets += surface.triangle_count();
  const std::string which = "body '" + body["name"].text() + "': ";
  const std::vector<int> first = first_agreeing_corner(surface);
  int open = 0;
  for (int v = 0; v < surface.vertex_count(); ++v) open += first[v] != v;
  if (open > 0)
    loader.notes.push_back(which + std::to_string(open) +
                           " vertices of open edges lie on others, without a seam between "
                           "them; aspic check MESH --repair merges them");
  aspic::place(placement_of(body), surface.vertices);
  TetMesh mesh{.rest = surface.vertices, .tets = {}, .region = {}};
  mesh.sheet = surface.triangles;
  const double thickness = body["shell"]["thickness"].number();
  mesh.thickness.assign(mesh.sheet.size(), thickness);
  if (pattern) add_pattern(body, std::move(uv), mesh, loader.notes);
  const double extent = longest_side(bounding_box(mesh.rest));
  require_proportion(body["shell"], "thickness", extent);
  if (thickness > kThick * extent)
    loader.notes.push_back("body '" + body["name"].text() + "': its thickness of " + number_text(thickness) +
                           " m is much for a sheet of " + three_digits(extent) +
                           " m: shells bend by less than a tenth of that (model it by tets)");
  check_fingerprint(body.table(), "mesh_hash", fingerprint_of(mesh), "the mesh of body '" + body["name"].text() + "'");
  BodyMesh result;
  for (int v = 0; v < surface.vertex_count(); ++v) result.embedding.carriers.push_back(Carrier::of_vertex(v));
  result.skin = std::move(surface);
  result.uv = std::move(texture);
  result.tets = std::move(mesh);
  return result;
}

std::unique_ptr<TetElasticity> sheet_elasticity(const PlacedBody& body, const BodyMaterial& material,
                                                const std::vector<char>& held, Model& model) {
  const Value& shell = body.scene["shell"];
  const std::vector<MaterialParameters>& parameters = material.parameters;
  SheetMaterial sheet;
  const bool is_elastic = body.scene["elastic"].boolean();
  if (const Value& bending = shell["bending"]; !is_elastic && bending.text() != "hinge")
    throw error_at(bending.place, "elastic = false excludes bending = \"mid_edge\"; remove one of the two");
  sheet.rest = shell["rest"].text() == "flat" ? RestAngles::flat : RestAngles::of_rest;
  for (size_t t = 0; t < parameters.size(); ++t) {
    if (!is_elastic) {
      sheet.laws.push_back(IsotropicSheet{0, 0, shell["thickness"].number()});
      sheet.moment.push_back(0);
      continue;
    }
    const double nu = poisson_ratio(parameters[t].lame);
    if (nu < 0)
      throw error_at(body.scene["material"].place, "Poisson's ratio is " + number_text(nu) + " in triangle " +
                                                       std::to_string(t) + "; that of a shell must be at least 0");
    sheet.laws.push_back(law_of(body, model.mesh, t, parameters[t]));
    sheet.moment.push_back(moment_of(shell, parameters[t]));
  }
  if (shell.find("yield")) add_creases(body, model, sheet);
  if (shell["bending"].text() == "mid_edge") add_mid_edges(body, material, model, sheet);
  sheet.held = held;
  if (shell.find("limit")) check_limit(body, limit_of(shell, 0), model);
  return make_sheet_elasticity(model.mesh, body.first_triangle, sheet);
}

void add_wind(const Table& document, const std::vector<PlacedBody>& bodies, Model& model,
              std::vector<std::string>& notes) {
  const Value* table = document.find("wind");
  if (!table) return;
  if (model.mesh.sheet.empty())
    throw error_at(table->place, "wind: no body is a sheet (wind drags only bodies with `shell`)");
  const Value& integrator = (*document.find("time"))["integrator"];
  if (!make_integrator(integrator.text())->facts().is_implicit)
    throw error_at(integrator.place, "integrator = " + toml_string(integrator.text()) +
                                         "; wind needs an implicit one (try backward_euler)");
  const Value& velocity = (*table)["velocity"];
  const WindLaw law{(*table)["density"].number(), (*table)["normal"].number(), (*table)["tangential"].number()};
  const auto field = [formula = VectorField(velocity, ExpressionVariables::position_and_time), place = velocity.place](
                         const Vec3d& x, double time) {
    try {
      const Vec3d u = formula.at(x, time);
      if (norm(u) > kFastest)
        throw InvalidInput("wind of " + three_digits(norm(u)) + " m/s; drag holds to 1e4 m/s (check the formula)");
      return u;
    } catch (const InvalidInput& e) {  // possibly long after the scene was read
      throw error_at(place, e.what());
    }
  };
  const Surroundings air{field, document.find("gravity")->vector(), (*document.find("time"))["duration"].number()};
  for (const PlacedBody& body : bodies)
    if (const auto normal = normal_across_wind(body, air))
      notes.push_back("body '" + body.name() +
                      "': the wind blows exactly in the plane of this flat sheet, so no pressure bends it; tilt "
                      "wind.velocity, for example by 1 % of its speed along the normal " +
                      direction_text(*normal));
  auto wind = make_wind(model.mesh.sheet, law, field);
  model.wind = wind.get();
  model.damping.push_back(std::move(wind));
}

}  // namespace aspic
