#include "scene/body_mesh.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <variant>

#include "base/error.h"
#include "base/free_memory.h"
#include "base/printable.h"
#include "io/mesh_file.h"
#include "io/tetrahedralize.h"
#include "mesh/box.h"
#include "mesh/chamber.h"
#include "mesh/doctor.h"
#include "mesh/generators.h"
#include "mesh/sheet_shapes.h"
#include "mesh/surface.h"
#include "mesh/surface_orientation.h"
#include "mesh/tet_nodes.h"
#include "scene/body_rod.h"
#include "scene/body_sheet.h"
#include "scene/placement.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr int kManyTets = 300'000;                 // about a second of work
constexpr std::uintmax_t kManyBytes = 30'000'000;  // of a file
constexpr double kBytesPerTet = 1000;              // upper bound of the size in a file
constexpr double kBytesInModel = 500;              // lower bound of the memory of a simulated tet
constexpr double kBytesOfQuadratic = 3000;         // of a quadratic one

// Replaces the option in the remedy by a whole command.
std::string sentence(const Finding& finding) {
  std::string remedy = finding.remedy;
  if (const size_t option = remedy.find("--repair"); option != std::string::npos)
    remedy.replace(option, 8, "aspic check MESH --repair -o MENDED");
  std::string which;
  const size_t shown = std::min<size_t>(finding.indices.size(), 5);
  for (size_t i = 0; i < shown; ++i) which += (i ? ", " : " (") + std::to_string(finding.indices[i]);
  if (shown > 0) which += shown < finding.indices.size() ? ", ...)" : ")";
  return finding.message + which + (remedy.empty() ? "" : "; " + remedy);
}

void heed(const std::vector<Finding>& findings, const std::string& what, std::vector<std::string>& notes) {
  for (const Finding& f : findings)
    if (f.severity == Severity::error) throw InvalidInput(what + ": " + sentence(f));
  for (const Finding& f : findings)
    if (f.severity == Severity::warning) notes.push_back(what + ": " + sentence(f));
}

std::string rounded_text(double count) {  // "3.56e+10"
  std::ostringstream text;
  text << std::setprecision(3) << count;
  return text.str();
}

void check_count(double tets, const Value& shape, const MeshLoader& loader) {
  const std::string why = loader.why_not(tets);
  if (!why.empty()) throw error_at(shape.place, why + " (choose a larger size, or fewer cells)");
}

TetMesh box_mesh(const Value& box, const MeshLoader& loader) {
  const BoxCells count = cells_of(box);
  check_count(count.tets(), box, loader);
  return make_box(box["lower"].vector(), box["upper"].vector(), count.integers(), count.cut);
}

// A tet of edge length s has the volume s^3 / (6 sqrt 2).
double tets_in(double volume, double size) { return volume * 6 * std::sqrt(2.0) / (size * size * size); }

bool is_tetgen(const fs::path& path) { return path.extension() == ".node" || path.extension() == ".ele"; }

// Returns the name of a mesh file in the results. A TetGen mesh has two files.
std::string keep_mesh_file(const fs::path& path, const std::string& stem, SceneFiles& files) {
  if (!is_tetgen(path)) return files.keep(path, stem);
  files.keep(fs::path(path).replace_extension(".ele"), stem);
  return files.keep(fs::path(path).replace_extension(".node"), stem);
}

double mesh_size_of(const Value& body) {
  const Value* size = body.find("mesh_size");
  return size ? size->number() : 0;
}

// Reads or generates the tets, and rewrites `body` so that the resolved scene gives the same ones.
LoadedMesh resolve_mesh(Value& body, MeshLoader& loader, std::optional<LoadedMesh> loaded) {
  const std::string name = body["name"].text();
  if (const Value* shape = body.find("shape")) return {shape_mesh(*shape, loader), {}};
  const Value mesh = body["mesh"];
  const fs::path path = loader.files.find(mesh);
  if (!loaded) {
    try {
      loaded = load_mesh(path, mesh_size_of(body), loader);
    } catch (const InvalidInput& e) {
      throw error_at(mesh.place, std::string("mesh = ") + toml_string(mesh.text()) + ": " + e.what());
    }
  }
  if (loaded->surface.empty()) {
    if (const Value* size = body.find("mesh_size"))
      throw error_at(size->place, "mesh_size = " + number_text(size->number()) + "; " + path.string() +
                                      " already contains tets; remove mesh_size");
    body.table().set("mesh", {keep_mesh_file(path, name, loader.files), {}});
    return *std::move(loaded);
  }
  body.table().set("mesh", {loader.files.keep(loaded->tets, name), {}});
  std::erase_if(body.table().members, [](const Member& m) { return m.key == "mesh_size"; });
  return *std::move(loaded);
}

TetMesh chamber_mesh(const Value& shape, const MeshLoader& loader) {
  const auto number = [&](const char* key) { return shape[key].number(); };
  const Chamber chamber{number("inner_radius"), number("inner_length"), number("outer_radius"), number("outer_length"),
                        number("base")};
  const auto need = [&](bool holds, const char* key, const std::string& condition) {
    if (!holds)
      throw error_at(shape[key].place, std::string(key) + " = " + number_text(number(key)) + "; " + condition);
  };
  need(chamber.outer_radius > chamber.inner_radius, "outer_radius", "must be above inner_radius");
  need(chamber.outer_length > chamber.inner_length, "outer_length", "must be above inner_length");
  need(std::abs(chamber.base) < chamber.inner_length, "base", "must be within inner_length of the center");
  check_count(tets_in_chamber(chamber, number("size")), shape, loader);
  return make_chamber(chamber, chamber_cells(chamber, number("size")));
}

// Exact: each vertex of the boundary is a vertex of the tets.
BodyMesh with_boundary_as_skin(TetMesh tets) {
  BoundarySurface boundary = boundary_surface(tets);
  BodyMesh body;
  for (const int v : boundary.tet_vertex) body.embedding.carriers.push_back(Carrier::of_vertex(v));
  body.skin = std::move(boundary.surface);
  body.tets = std::move(tets);
  return body;
}

BodyMesh with_skin(TetMesh tets, TriMesh skin) {
  BodyMesh body{std::move(tets), std::move(skin), {}};
  body.embedding = embed(body.tets, body.skin);
  return body;
}

// Returns why tets do not fit into the memory; empty: they do.
std::string lack_of_memory(const TetLimit& limit, double tets, double bytes_per_tet) {
  const double bytes = tets * bytes_per_tet;
  const auto available = static_cast<double>(std::min(limit.memory, free_memory()));
  if (bytes <= available) return "";
  return "about " + rounded_text(tets) + " tets need at least " + rounded_text(bytes / 1e9) + " GB; " +
         rounded_text(available / 1e9) + " GB of memory are free";
}

// Makes the tets quadratic if the body has order 2.
void raise_order_of(const Value& body, const TetLimit& limit, TetMesh& mesh) {
  const Value& order = body["order"];
  if (order.number() != 2) return;
  if (!body["elastic"].boolean())
    throw error_at(order.place, "order = 2; quadratic tets need elastic = true (remove one of the two)");
  if (const std::string why = lack_of_memory(limit, mesh.tet_count(), kBytesOfQuadratic); !why.empty())
    throw error_at(order.place, "order = 2: " + why + " (choose a coarser mesh, or order = 1)");
  mesh = raise_order(std::move(mesh));
}

// For skins chosen by the scene. The surface of a filled mesh is always slightly outside.
void note_outside(const BodyMesh& body, const std::string& name, std::vector<std::string>& notes) {
  if (const int outside = body.embedding.outside; outside > 0)
    notes.push_back("body '" + name + "': " + std::to_string(outside) + " of " +
                    std::to_string(body.skin.vertex_count()) +
                    " skin vertices are outside the tets and follow the nearest one");
}

// Largest distance of the corners of a box from another box.
double farthest(const Box& box, const Box& from) {
  double most = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3d x;
    for (int i = 0; i < 3; ++i) x[i] = corner >> i & 1 ? box.upper[i] : box.lower[i];
    most = std::max(most, from.squared_distance(x));
  }
  return std::sqrt(most);
}

// Refuses a skin in other units than the tets, or elsewhere.
void refuse_foreign_skin(const BodyMesh& body, const Value& skin) {
  constexpr double kDiagonals = 10;
  const Box tets = bounding_box(body.tets.rest), own = bounding_box(body.skin.vertices);
  const double of_tets = norm(tets.upper - tets.lower), of_skin = norm(own.upper - own.lower);
  const std::string which = "skin = " + shortened(toml_string(skin.text()));
  if (const double beyond = farthest(tets, own); beyond > kDiagonals * of_skin)
    throw error_at(skin.place, which + "; the tets reach " + rounded_text(beyond) +
                                   " m beyond the skin, whose diagonal is " + rounded_text(of_skin) +
                                   " m: give both in the same units and coordinates");
  if (const double beyond = farthest(own, tets); beyond > kDiagonals * of_tets)
    throw error_at(skin.place, which + "; the skin reaches " + rounded_text(beyond) +
                                   " m beyond the tets, whose diagonal is " + rounded_text(of_tets) +
                                   " m: give both in the same units and coordinates");
}

// Refuses files that must exceed the limit, and announces large ones.
void check_size(const fs::path& path, const MeshLoader& loader) {
  std::error_code error;
  const std::uintmax_t bytes = fs::file_size(path, error);
  if (error || bytes < kManyBytes) return;
  const std::string size = std::to_string(bytes / 1'000'000) + " MB";
  if (loader.limit.counts_files && static_cast<double>(bytes) > kBytesPerTet * loader.limit.tets)
    throw InvalidInput(path.string() + ": " + size + "; at most " + number_text(loader.limit.tets) + " tets " +
                       loader.limit.why + " (choose a coarser mesh)");
  loader.report("reading " + path.filename().string() + " (" + size + ")");
}

}  // namespace

double BoxCells::tets() const { return (cut == BoxCut::five ? 5 : 6) * count[0] * count[1] * count[2]; }

BoxCells cells_of(const Value& box) {
  const Vec3d lower = box["lower"].vector(), upper = box["upper"].vector();
  BoxCells cells;
  for (int i = 0; i < 3; ++i) {
    const Value* size = box.find("size");
    cells.count[i] =
        size ? std::max(1.0, std::round((upper[i] - lower[i]) / size->number())) : box["cells"].array()[i].number();
  }
  cells.cut = box["cut"].text() == "five" ? BoxCut::five : BoxCut::kuhn;
  return cells;
}

TriMesh shape_surface(const Value& shape, const MeshLoader& loader) {
  const auto number = [](const Value& table, const char* key) { return table[key].number(); };
  if (const Value* s = shape.find("rectangle")) {
    const double w = number(*s, "width"), h = number(*s, "height"), size = number(*s, "size");
    check_count(triangles_in_rectangle(w, h, size), *s, loader);
    return make_rectangle(w, h, size);
  }
  if (const Value* s = shape.find("disc")) {
    const double r = number(*s, "radius"), size = number(*s, "size");
    check_count(triangles_in_disc(r, size), *s, loader);
    return make_disc(r, size);
  }
  if (const Value* s = shape.find("tube")) {
    const double r = number(*s, "radius"), h = number(*s, "height"), size = number(*s, "size");
    check_count(triangles_in_tube(r, h, size), *s, loader);
    return make_tube(r, h, size);
  }
  return boundary_surface(shape_mesh(shape, loader)).surface;
}

TetMesh shape_mesh(const Value& shape, const MeshLoader& loader) {
  for (const char* sheet : {"rectangle", "disc", "tube"})
    if (const Value* s = shape.find(sheet))
      throw error_at(s->place, std::string(sheet) + ": a sheet encloses no volume (add shell = { thickness = 0.001 } " +
                                   "to the body)");
  for (const char* rod : {"line", "ring", "coil"})
    if (const Value* s = shape.find(rod))
      throw error_at(s->place,
                     std::string(rod) + ": a polyline has no surface (add rod = { radius = 0.001 } to the " + "body)");
  const auto number = [](const Value& table, const char* key) { return table[key].number(); };
  if (const Value* box = shape.find("box")) return box_mesh(*box, loader);
  if (const Value* c = shape.find("cylinder")) {
    const double r = number(*c, "radius"), h = number(*c, "height"), size = number(*c, "size");
    check_count(tets_in_cylinder(r, h, size), *c, loader);
    return make_cylinder(r, h, size);
  }
  if (const Value* s = shape.find("sphere")) {
    const double r = number(*s, "radius"), size = number(*s, "size");
    check_count(tets_in(4.19, size / r), *s, loader);
    return make_sphere(r, size);
  }
  if (const Value* c = shape.find("chamber")) return chamber_mesh(*c, loader);
  const Value& t = shape["torus"];
  const double major = number(t, "major_radius"), minor = number(t, "minor_radius"), size = number(t, "size");
  if (!(minor < major))
    throw error_at(t["minor_radius"].place,
                   "minor_radius = " + number_text(minor) + "; must be below major_radius = " + number_text(major));
  check_count(tets_in_torus(major, minor, size), t, loader);
  return make_torus(major, minor, size);
}

void MeshLoader::report(const std::string& what) const {
  if (announce) announce(printable(what));
}

void MeshLoader::report_if_many(int tet_count, const std::string& what) const {
  if (tet_count >= kManyTets) report(what);
}

std::string MeshLoader::why_not(double more_tets) const {
  const double all = tets + more_tets;
  if (all <= limit.tets) return why_not_in_memory(more_tets);
  return "about " + rounded_text(all) + " tets; at most " + number_text(limit.tets) + " " + limit.why;
}

std::string MeshLoader::why_not_in_memory(double more_tets) const {
  return lack_of_memory(limit, tets + more_tets, kBytesInModel);
}

LoadedMesh load_mesh(const fs::path& path, double size, MeshLoader& loader) {
  check_size(path, loader);
  MeshGroups groups;
  std::variant<TetMesh, TriMesh> mesh = read_mesh(path, &loader.notes, &groups);
  if (TetMesh* tets = std::get_if<TetMesh>(&mesh)) {
    const int count = tets->tet_count();
    const std::string why = loader.limit.counts_files ? loader.why_not(count) : loader.why_not_in_memory(count);
    if (!why.empty()) throw InvalidInput(path.string() + ": " + why + " (choose a coarser mesh)");
    return {std::move(*tets), {}, std::move(groups)};
  }
  TriMesh& surface = std::get<TriMesh>(mesh);
  repair(surface);  // as the mesher does, which reports it
  heed(diagnose(surface), path.string(), loader.notes);
  if (size > 0)
    if (const std::string why = loader.why_not(tets_in(std::abs(enclosed_volume(surface)), size)); !why.empty())
      throw InvalidInput(path.string() + ", filled with edges of length " + number_text(size) + ": " + why +
                         " (choose a larger mesh_size)");
  loader.report("filling " + path.filename().string() + " with tets");
  Tetrahedralization filled =
      tetrahedralize(path, {.size = size, .seconds = loader.mesher_seconds, .program = loader.mesher});
  const std::string length = size > 0 ? number_text(size) : "the diagonal of the bounding box / 25";
  loader.notes.push_back(path.filename().string() + ": a surface; filled with " +
                         std::to_string(filled.tets.tet_count()) + " tets of edge length " + length +
                         " (mesh_size changes it)");
  for (const std::string& note : filled.notes) loader.notes.push_back(path.filename().string() + ": " + note);
  return {std::move(filled.tets), path};
}

namespace {

BodyMesh with_its_skin(Value& body, MeshLoader& loader, LoadedMesh mesh) {
  const std::string name = body["name"].text();
  loader.tets += mesh.tets.tet_count();
  check_fingerprint(body.table(), "mesh_hash", fingerprint_of(mesh.tets), "the mesh of body '" + name + "'");
  const AffineMap map = placement_of(body);
  place(map, mesh.tets.rest);
  loader.report_if_many(mesh.tets.tet_count(),
                        "checking " + std::to_string(mesh.tets.tet_count()) + " tets of body '" + name + "'");
  heed(diagnose(mesh.tets), "body '" + name + "'", loader.notes);
  raise_order_of(body, loader.limit, mesh.tets);

  const Value* skin = body.find("skin");
  if (!skin && mesh.surface.empty()) return with_boundary_as_skin(std::move(mesh.tets));
  const fs::path path = skin ? loader.files.find(*skin) : mesh.surface;
  TriMesh surface = read_tri_mesh(path);
  place(map, surface.vertices);
  const std::optional<Value> chosen = skin ? std::optional(*skin) : std::nullopt;
  body.table().set("skin", {loader.files.keep(path, name + ".skin"), {}});
  BodyMesh result = with_skin(std::move(mesh.tets), std::move(surface));
  result.uv = read_texture(path, result.skin.triangle_count(), loader.notes);
  if (!chosen) return result;
  refuse_foreign_skin(result, *chosen);
  note_outside(result, name, loader.notes);
  return result;
}

}  // namespace

BodyMesh make_body_mesh(Value& body, MeshLoader& loader, std::optional<LoadedMesh> loaded) {
  if (body.find("shell")) return make_sheet_mesh(body, loader);
  if (body.find("rod")) return make_rod_mesh(body, loader);
  LoadedMesh mesh = resolve_mesh(body, loader, std::move(loaded));
  MeshGroups groups = std::move(mesh.groups);
  BodyMesh result = with_its_skin(body, loader, std::move(mesh));
  result.groups = std::move(groups);
  return result;
}

}  // namespace aspic
