#include "scene/mesh_scene.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "base/error.h"
#include "contact/barrier.h"
#include "dynamics/model_builder.h"
#include "dynamics/simulation.h"
#include "mesh/box.h"
#include "mesh/components.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"
#include "mesh/tet_mesh.h"
#include "mesh/vertices.h"
#include "scene/mesh_defaults.h"
#include "scene/placement.h"
#include "scene/scene_document.h"

namespace aspic {
namespace {

struct SagOptions {
  double young = 1, poisson = 0.4, density = 1000;  // [Pa], [1], [kg/m^3]
  Vec3d gravity{{0, -9.81, 0}};                     // [m/s^2]
};

constexpr double kLongStep = 1;  // [s]; motions above one hertz come to rest in it

// Returns `held` and the vertices of every part without one of them.
std::vector<int> with_loose_parts(const TetMesh& mesh, std::vector<int> held) {
  std::vector<char> is_fixed(mesh.vertex_count(), 1);  // vertices of no tet stay fixed
  for (const Tet& tet : mesh.tets)
    for (const int v : tet) is_fixed[v] = 0;
  for (const int v : held) is_fixed[v] = 1;
  for (const std::vector<int>& part : tet_components(mesh)) {
    const bool is_loose = std::none_of(part.begin(), part.end(), [&](int t) {
      return std::any_of(mesh.tets[t].begin(), mesh.tets[t].end(), [&](int v) { return is_fixed[v] != 0; });
    });
    if (!is_loose) continue;
    for (const int t : part)
      for (const int v : mesh.tets[t]) is_fixed[v] = 1;
  }
  held.clear();
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (is_fixed[v]) held.push_back(v);
  return held;
}

// Returns the largest displacement [m] of the mesh in linear elasticity, inversely proportional to Young's modulus,
// with the vertices `held` fixed. Parts without such a vertex are ignored. NaN for a mesh with inverted tets or if the
// solve fails.
double sag(TetMesh mesh, std::vector<int> held, const SagOptions& options) {
  for (int t = 0; t < mesh.tet_count(); ++t)
    if (!(volume(mesh, t) > 0)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> X = at_rest(mesh).q;
  std::vector<int> fixed = with_loose_parts(mesh, std::move(held));
  // A long step instead of statics, so that bodies on hinges have a solution.
  SimulationOptions statics{.h = kLongStep, .integrator = "backward_euler"};
  statics.solver.minimize.tolerance = 1e-3;
  Simulation simulation(ModelBuilder(std::move(mesh))
                            .material("linear", {.young = options.young, .poisson = options.poisson})
                            .density(options.density)
                            .mass(MassKind::lumped)
                            .gravity(options.gravity)
                            .pin("held", std::move(fixed))
                            .build(),
                        statics);
  if (!is_success(simulation.step().status)) return std::numeric_limits<double>::quiet_NaN();
  const std::vector<double>& q = simulation.state().q;
  double largest = 0;
  for (size_t i = 0; i < q.size(); i += 3)
    largest = std::max(largest, std::hypot(q[i] - X[i], q[i + 1] - X[i + 1], q[i + 2] - X[i + 2]));
  return largest;
}

constexpr double kStrain = 0.05;   // rho g H / E: strain of the base of a column under its weight
constexpr double kSag = 0.05;      // displacement under the body's weight / largest extent
constexpr double kStiffest = 10;   // upper limit of E by the sag / E by the strain
constexpr double kDensity = 1000;  // [kg/m^3]
constexpr double kPoisson = 0.4;
constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kPull = 0.25;     // sideways displacement of the top / height
constexpr double kFall = 0.2;      // height of the fall / largest extent

// Returns a fraction of the height that contains more than one point of the body.
double base_fraction(const std::vector<Vec3d>& X, const Box& box) {
  const double height = box.upper[1] - box.lower[1];
  for (const double fraction : {0.02, 0.05, 0.1, 0.2}) {
    const auto is_low = [&](const Vec3d& P) { return P[1] <= box.lower[1] + fraction * height; };
    const auto count = std::count_if(X.begin(), X.end(), is_low);
    if (count >= 6 && count >= static_cast<std::ptrdiff_t>(X.size() / 100)) return fraction;
  }
  return 0.2;
}

struct Stiffness {
  double young = 1;  // [Pa]
  std::string reason;
};

// Young's modulus that carries the weight of the scaled body.
Stiffness stiffness_for(const TetMesh& mesh, double base) {
  const Box box = bounding_box(mesh.rest);
  const double height = std::max(box.upper[1] - box.lower[1], 1e-9);
  const double least = kDensity * kGravity * height / kStrain;
  std::vector<int> held = vertices_where(mesh, [&](const Vec3d& X) { return X[1] <= box.lower[1] + base * height; });
  const double depth = sag(mesh, std::move(held),
                           {.young = least, .poisson = kPoisson, .density = kDensity, .gravity = {{0, -kGravity, 0}}});
  const double share = depth / (kSag * longest_side(box));
  if (!(share > 1)) return {one_digit(least), "under its own weight the body is compressed by about 5 %"};
  if (share < kStiffest)
    return {one_digit(share * least), "under its own weight the body sinks by about 5 % of its size"};
  return {one_digit(kStiffest * least),
          "ten times the value for a column of its height; thin parts sink by more than 5 % of its size"};
}

// Returns why the mesh cannot have contact; empty if it can.
std::string contact_obstacle(const TetMesh& mesh) {
  const TriMesh surface = boundary_surface(mesh).surface;
  if (const auto pairs = self_intersections(surface, 1).pairs; !pairs.empty()) {
    const Vec3d& at = surface.vertices[surface.triangles[pairs.front()[0]][0]];
    return "its surface intersects itself near (" + number_text(at[0]) + ", " + number_text(at[1]) + ", " +
           number_text(at[2]) + ")";
  }
  ContactMesh contact;
  std::vector<int> rows(surface.vertices.size());
  std::iota(rows.begin(), rows.end(), 0);
  contact.add({.young = 1}, surface.vertices, surface.triangles, rows);
  const Barrier barrier(std::move(contact), {});
  return barrier.self_touching_point() < 0 ? "" : "its surface touches itself";
}

// How the default scene supports the body: by a floor, or by pins.
struct Support {
  bool is_floor = true;
  std::string reason;  // reason for pins; empty: an override requests them
};

Support support_for(const TetMesh& mesh, const std::vector<std::string>& overrides) {
  for (const char* key : {"pin", "deform", "time.integrator", "time.adaptive"})
    if (is_overridden(key, overrides)) return {false, ""};
  const std::string obstacle = contact_obstacle(mesh);
  return {obstacle.empty(), obstacle};
}

// Returns the part of the scene that supports the body, and its notes.
Defaults floor_below(const Box& box) {
  const double fall = one_digit(kFall * longest_side(box)), height = box.lower[1] - fall;
  return {"[contact]\nfriction = 0.3\n[[obstacle]]\nname = \"floor\"\nplane = { origin = [0.0, " + number_text(height) +
              ", 0.0] }\n",
          {{"obstacle", "obstacle: a floor " + number_text(fall) + " m below the body, which falls onto it"},
           {"contact.friction", "contact.friction = 0.3: dry rubber or wood"}}};
}

Defaults pinned_at_base(const Box& box, double base, const std::string& reason) {
  const double height = box.upper[1] - box.lower[1];
  const std::string pull =
      number_text(kPull * height) + " * ((Y - " + number_text(box.lower[1]) + ") / " + number_text(height) + ")^2";
  return {
      "deform = { displacement = [" + toml_string(pull) +
          ", 0.0, 0.0] }\n[[body.pin]]\nname = \"base\"\nwhere = { lowest = " + number_text(base) + " }\n",
      {{"pin", "pin: the lowest " + number_text(100 * base) + " % of the height is fixed, as if glued to the ground" +
                   (reason.empty() ? "" : ": contact with a floor is impossible, because " + reason)},
       {"deform", "deform: top pulled sideways by a quarter of the height, then released"}}};
}

Defaults defaults_for(const std::filesystem::path& path, TetMesh mesh, double scale,
                      const std::vector<std::string>& overrides) {
  const Box file_box = bounding_box(mesh.rest);
  for (Vec3d& P : mesh.rest) P = scale * P;
  const std::vector<Vec3d>& X = mesh.rest;
  const Box box = bounding_box(X);
  const double extent = longest_side(file_box);
  const double base = base_fraction(X, box);
  const bool has_file = is_overridden("material.file", overrides);  // which defines model and parameters
  const bool needs_young = !has_file && !is_overridden("material.young", overrides);
  const auto [young, reason] = needs_young ? stiffness_for(mesh, base) : Stiffness{};
  const Support support = support_for(mesh, overrides);
  const Defaults held = support.is_floor ? floor_below(box) : pinned_at_base(box, base, support.reason);

  Defaults d;
  d.toml = "gravity = [0.0, -9.81, 0.0]\n[time]\nstep = 0.01\nduration = 2.0\n[[body]]\nmesh = " +
           toml_string(path.string()) + "\nscale = " + number_text(scale) + "\nmaterial = { " +
           (has_file ? "" : "model = \"neo_hookean_log\", ") + "young = " + number_text(young) +
           ", poisson = 0.4, density = 1000.0 }\n" + held.toml;
  d.choices = choices_of_space(scale, extent);
  d.choices.push_back({"material.model",
                       "material.model = neo_hookean_log: its energy is infinite for flat tets, so that none inverts"});
  d.choices.push_back({"material.young", "material.young = " + number_text(young) + " Pa: " + reason});
  d.choices.push_back({"material.poisson",
                       "material.poisson = 0.4: rubber or flesh within the limits of linear tets "
                       "well"});
  d.choices.push_back({"material.density", "material.density = 1000 kg/m^3: water and soft tissue"});
  d.choices.insert(d.choices.end(), held.choices.begin(), held.choices.end());
  d.choices.push_back({"time.step", "time.step = 0.01 s: resolves oscillations of a few hertz"});
  d.choices.push_back({"time.duration", "time.duration = 2 s: several oscillations"});
  return d;
}

}  // namespace

SceneSource scene_of_mesh(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                          MeshLoader& loader) {
  const std::string file = path.string();
  // Other defaults depend on overrides of the size of tets and the scale.
  const auto read = [&](const std::string& toml) {
    return read_scene_document(toml, "defaults for " + file, overrides);
  };
  const std::string minimal =
      "[time]\n[[body]]\nmesh = " + toml_string(file) +
      "\nmaterial = { young = 1e5, poisson = 0.4 }\ndeform = { displacement = [0, 0, 0] }\n[[body.pin]]\nname = "
      "\"base\"\nwhere = { lowest = 0.05 }\n[contact]\n[[obstacle]]\nplane = {}\n";
  const Table first = read(minimal);
  const Value& body = first.find("body")->array().front();
  const bool has_scale = is_overridden("scale", overrides) && body["scale"].is_number();
  const auto thin_scene = [&](const Defaults& defaults) -> SceneSource {
    return {read(defaults.toml), path.stem().string(), file, {}, notes_of(defaults, overrides)};
  };
  const auto placed = [&](const std::vector<Vec3d>& X) -> ThinPlacement {
    return {has_scale ? body["scale"].number() : guessed_scale(X), first.find("gravity")->vector()};
  };
  if (const std::optional<TetMesh> rod = rod_in(path, is_overridden("rod", overrides)))
    return thin_scene(defaults_for_rod(path, *rod, placed(rod->rest)));
  if (const std::optional<TriMesh> sheet = sheet_in(path, is_overridden("shell", overrides)))
    return thin_scene(defaults_for_sheet(path, *sheet, placed(sheet->vertices)));
  const Value* size = body.find("mesh_size");
  LoadedMesh mesh = load_mesh(path, size ? size->number() : 0, loader);
  if (mesh.tets.rest.empty() || mesh.tets.tets.empty())
    throw InvalidInput(file + ": contains no tets and no triangles; use a mesh with tets, a surface or lines");
  const double extent = longest_side(bounding_box(mesh.tets.rest));
  if (!(extent > 0) || !std::isfinite(extent)) throw InvalidInput(file + ": all vertices coincide; use another mesh");

  const double scale = has_scale ? body["scale"].number() : guessed_scale(mesh.tets.rest);
  const Defaults defaults = defaults_for(path, mesh.tets, scale, overrides);
  SceneSource source{read(defaults.toml), path.stem().string(), file, {}, notes_of(defaults, overrides)};
  const std::string name = source.document.find("body")->array().front()["name"].text();
  source.meshes.emplace(name, std::move(mesh));
  return source;
}

}  // namespace aspic
