// Meshes as arrays: files, generators, diagnosis and repair.
#include "mesh/doctor.h"

#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "base/error.h"
#include "bindings.h"
#include "interpreter.h"
#include "io/mesh_file.h"
#include "io/tetrahedralize.h"
#include "mesh/generators.h"
#include "mesh/surface.h"
#include "mesh/tet_shape.h"
#include "scene/value.h"

namespace aspic::python {
namespace {

namespace fs = std::filesystem;

py::tuple arrays_of(const TetMesh& mesh) {
  py::array_t<int> tets({static_cast<py::ssize_t>(mesh.tets.size()), py::ssize_t{4}});
  std::copy_n(mesh.tets.data()->data(), tets.size(), tets.mutable_data());
  py::object region = py::none();
  if (!mesh.region.empty()) region = to_array(mesh.region, {static_cast<py::ssize_t>(mesh.region.size())});
  return py::make_tuple(to_array(mesh.rest), tets, region);
}

py::array_t<int> array_of(const std::vector<Triangle>& triangles) {
  py::array_t<int> array({static_cast<py::ssize_t>(triangles.size()), py::ssize_t{3}});
  if (!triangles.empty()) std::copy_n(triangles.data()->data(), array.size(), array.mutable_data());
  return array;
}

TetMesh tet_mesh(const py::handle& vertices, const py::handle& tets, const py::handle& region) {
  TetMesh mesh;
  const Array points = reals(vertices, "vertices", {-1, 3});
  mesh.rest = to_points(points);
  const std::vector<int> corners = indices(tets, "tets", {-1, 4}, points.shape(0));
  if (corners.empty()) throw InvalidInput("tets: there are none; a body needs at least one");
  mesh.tets.resize(corners.size() / 4);
  std::copy(corners.begin(), corners.end(), mesh.tets.data()->data());
  if (!region.is_none()) mesh.region = indices(region, "region", {static_cast<py::ssize_t>(mesh.tets.size())}, INT_MAX);
  return mesh;
}

TriMesh tri_mesh(const py::handle& vertices, const py::handle& triangles) {
  TriMesh mesh;
  const Array points = reals(vertices, "vertices", {-1, 3});
  mesh.vertices = to_points(points);
  const std::vector<int> corners = indices(triangles, "triangles", {-1, 3}, points.shape(0));
  for (size_t i = 0; i + 2 < corners.size(); i += 3)
    mesh.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  return mesh;
}

py::list list_of(const std::vector<Finding>& findings) {
  const char* names[] = {"error", "warning", "note"};
  py::list list;
  for (const Finding& f : findings) {
    py::dict entry;
    entry["severity"] = names[static_cast<int>(f.severity)];
    entry["name"] = f.name;
    entry["message"] = f.message;
    entry["remedy"] = f.remedy;
    entry["indices"] = to_array(f.indices, {static_cast<py::ssize_t>(f.indices.size())});
    list.append(entry);
  }
  return list;
}

py::object read(const fs::path& path) {
  std::variant<TetMesh, TriMesh> mesh;
  {
    const ReleasedGil free;
    mesh = read_mesh(path);
  }
  if (const auto* tets = std::get_if<TetMesh>(&mesh)) return arrays_of(*tets);
  const auto& surface = std::get<TriMesh>(mesh);
  return py::make_tuple(to_array(surface.vertices), array_of(surface.triangles));
}

Vec3d vector_of(const py::handle& value, const std::string& name) {
  const Array numbers = reals(value, name, {3});
  return {{numbers.data()[0], numbers.data()[1], numbers.data()[2]}};
}

double positive(double value, const char* name) {
  if (!(value > 0) || !std::isfinite(value))
    throw InvalidInput(std::string(name) + " = " + number_text(value) + "; must be positive and finite");
  return value;
}

constexpr double kMaxTets = 2e7;
void check_count(double tets) {
  if (!(tets <= kMaxTets))
    throw InvalidInput("size: about " + std::to_string(tets) +
                       " tets; at most 2e+07 are generated (choose a larger size)");
}

py::tuple box(const py::handle& origin, const py::handle& size, const std::vector<int>& cells, const std::string& cut) {
  const Vec3d low = vector_of(origin, "origin"), high = low + vector_of(size, "size");
  if (cells.size() != 3) throw InvalidInput("cells: three counts are needed");
  for (int i = 0; i < 3; ++i) {
    if (cells[i] < 1) throw InvalidInput("cells: " + std::to_string(cells[i]) + "; each count must be at least 1");
    if (!(high[i] > low[i]))
      throw InvalidInput("size: " + number_text(high[i] - low[i]) + "; each number must be positive");
  }
  if (cut != "kuhn" && cut != "five") throw InvalidInput("cut: unknown name" + suggestion(cut, {"kuhn", "five"}));
  check_count(6.0 * cells[0] * cells[1] * cells[2]);
  return arrays_of(make_box(low, high, {cells[0], cells[1], cells[2]}, cut == "five" ? BoxCut::five : BoxCut::kuhn));
}

py::tuple cylinder(double radius, double height, double size) {
  check_count(tets_in_cylinder(positive(radius, "radius"), positive(height, "height"), positive(size, "size")));
  return arrays_of(make_cylinder(radius, height, size));
}

py::tuple sphere(double radius, double size) {
  positive(radius, "radius"), positive(size, "size");
  check_count(36 * radius * radius * radius / (size * size * size));
  return arrays_of(make_sphere(radius, size));
}

py::tuple torus(double major, double minor, double size) {
  if (!(positive(minor, "minor_radius") < positive(major, "major_radius")))
    throw InvalidInput("minor_radius: must be below major_radius");
  check_count(tets_in_torus(major, minor, positive(size, "size")));
  return arrays_of(make_torus(major, minor, size));
}

py::dict quality_of(const TetMesh& mesh) {
  const MeshQuality q = quality(mesh);
  py::dict result;
  result["min_volume"] = q.min_volume;
  result["max_volume"] = q.max_volume;
  result["total_volume"] = q.total_volume;
  result["min_dihedral"] = q.min_dihedral;
  result["max_dihedral"] = q.max_dihedral;
  result["min_mean_ratio"] = q.min_mean_ratio;
  result["average_mean_ratio"] = q.average_mean_ratio;
  result["components"] = q.components;
  return result;
}

}  // namespace

void bind_mesh(py::module_& m) {
  using Handle = const py::object&;
  m.def("read_mesh", &read, "Returns (vertices, tets, region) of a file, or (vertices, triangles).");
  m.def("write_mesh", [](const fs::path& path, Handle vertices, Handle tets, Handle region, bool binary) {
    const TetMesh mesh = tet_mesh(vertices, tets, region);
    const ReleasedGil free;
    write_mesh(path, mesh, binary ? FileEncoding::binary : FileEncoding::ascii);
  });
  m.def("write_surface", [](const fs::path& path, Handle vertices, Handle triangles) {
    write_mesh(path, tri_mesh(vertices, triangles));
  });
  m.def(
      "check_arrays",
      [](Handle vertices, Handle tets, Handle region) { return arrays_of(tet_mesh(vertices, tets, region)); },
      "Returns the arrays of a mesh in their types; raises InvalidInput for others.");
  m.def(
      "check_surface",
      [](Handle vertices, Handle triangles) {
        const TriMesh mesh = tri_mesh(vertices, triangles);
        return py::make_tuple(to_array(mesh.vertices), array_of(mesh.triangles));
      },
      "Returns the arrays of a surface in their types; raises InvalidInput for others.");
  m.def("diagnose", [](Handle vertices, Handle tets, Handle region) {
    return list_of(diagnose(tet_mesh(vertices, tets, region)));
  });
  m.def("diagnose_surface",
        [](Handle vertices, Handle triangles) { return list_of(diagnose(tri_mesh(vertices, triangles))); });
  m.def("quality", [](Handle vertices, Handle tets) { return quality_of(tet_mesh(vertices, tets, py::none())); });
  m.def("repair", [](Handle vertices, Handle tets, Handle region) {
    TetMesh mesh = tet_mesh(vertices, tets, region);
    const std::vector<std::string> actions = repair(mesh);
    return py::make_tuple(arrays_of(mesh), actions);
  });
  m.def("volumes", [](Handle vertices, Handle tets) {
    const TetMesh mesh = tet_mesh(vertices, tets, py::none());
    std::vector<double> volumes;
    for (int t = 0; t < mesh.tet_count(); ++t) volumes.push_back(volume(mesh, t));
    return to_array(volumes, {static_cast<py::ssize_t>(volumes.size())});
  });
  m.def("boundary", [](Handle vertices, Handle tets) {
    const TetMesh mesh = tet_mesh(vertices, tets, py::none());
    return array_of(boundary_triangles(mesh, 0, mesh.tet_count()));
  });
  m.def("fill", [](const fs::path& surface, double size, const fs::path& program) {
    Tetrahedralization filled;
    {
      const ReleasedGil free;
      filled = tetrahedralize(surface, {.size = size, .program = program});
    }
    return py::make_tuple(arrays_of(filled.tets), filled.notes);
  });
  m.def("require_bounded", &require_bounded, "Raises InvalidInput for a broadcast array whose copy fills the memory.");
  m.def("box", &box);
  m.def("cylinder", &cylinder, py::arg("radius"), py::arg("height"), py::arg("size"));
  m.def("sphere", &sphere, py::arg("radius"), py::arg("size"));
  m.def("torus", &torus, py::arg("major_radius"), py::arg("minor_radius"), py::arg("size"));
}

}  // namespace aspic::python
