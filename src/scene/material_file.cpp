#include "scene/material_file.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "base/error.h"
#include "base/parallel.h"
#include "io/legacy_vtk.h"
#include "io/vtu.h"
#include "material/registry.h"
#include "mesh/locate.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "mesh/vertices.h"
#include "scene/schema.h"
#include "scene/value.h"

namespace aspic {
namespace {

// Name of a file field for the model, which ParaView shows and every VTU reader accepts.
const std::string kModelField = "model ";

bool is_quantity(const std::string& name) {
  if (name == "young" || name == "poisson" || name == "density") return true;
  return std::any_of(materials().begin(), materials().end(), [&](const MaterialInfo& info) {
    return std::any_of(info.extra.begin(), info.extra.end(), [&](const ExtraParameter& e) { return e.name == name; });
  });
}

// The range of the scene's key of the same name.
Range range_of(const std::string& quantity, const std::string& model) {
  for (const ExtraParameter& e : material_info(model).extra)
    if (e.name == quantity) return {.min = e.min, .max = e.max};
  return scene_schema().key("material", quantity).range;
}

std::string model_of(const Vtu& vtu, const std::string& file) {
  std::string model;
  for (const Field& field : vtu.file_fields) {
    if (!field.name.starts_with(kModelField)) continue;
    if (!model.empty())
      throw InvalidInput(file + ": contains two models, '" + model + "' and '" + field.name.substr(kModelField.size()) +
                         "'; keep one of the fields of the file");
    model = field.name.substr(kModelField.size());
    try {
      material_info(model);
    } catch (const InvalidInput& e) {
      throw InvalidInput(file + ": " + e.what());
    }
  }
  return model;
}

}  // namespace

const std::vector<double>* FittedMaterial::find(const std::string& quantity) const {
  for (const auto& [name, numbers] : values)
    if (name == quantity) return &numbers;
  return nullptr;
}

std::vector<std::string> quantities_of(const std::string& model) {
  std::vector<std::string> names = {"young", "poisson"};
  for (const ExtraParameter& extra : material_info(model).extra) names.push_back(extra.name);
  return names;
}

FittedMaterial read_material(const std::filesystem::path& path) {
  Vtu vtu = read_vtk_or_vtu(path);
  if (vtu.mesh.tets.empty())
    throw InvalidInput(path.string() + ": has no tets; a material file needs tets with fields");
  FittedMaterial material{.mesh = std::move(vtu.mesh), .model = model_of(vtu, path.string())};
  for (Field& field : vtu.cell_fields) {
    if (field.name == "region") continue;  // of the mesh
    const bool is_value = is_quantity(field.name);
    if (is_value && field.components != 1)
      throw InvalidInput(path.string() + ": cell field '" + field.name + "' has " + std::to_string(field.components) +
                         " components; one per tet is needed");
    if (field.components != 1) continue;
    auto& list = is_value ? material.values : material.further;
    list.emplace_back(field.name, std::move(field.values));
  }
  if (!material.model.empty()) check_material(material, material.model, path.string());
  return material;
}

void check_material(const FittedMaterial& material, const std::string& model, const std::string& file) {
  const auto check = [&](const std::string& name, const std::vector<double>& numbers) {
    const Range range = range_of(name, model);
    for (size_t t = 0; t < numbers.size(); ++t)
      if (!std::isfinite(numbers[t]) || !range.contains(numbers[t]))
        throw InvalidInput(file + ": " + name + " = " + number_text(numbers[t]) + " in tet " + std::to_string(t) +
                           " at " + point_text(centroid(material.mesh, static_cast<int>(t))) + "; must be " +
                           (range.text().empty() ? "finite" : range.text()) + " (correct the file, or fit again)");
  };
  for (const std::string& name : quantities_of(model)) {
    const std::vector<double>* numbers = material.find(name);
    if (!numbers) {
      std::vector<std::string> known;
      for (const auto& [given, ignored] : material.values) known.push_back(given);
      for (const auto& [given, ignored] : material.further) known.push_back(given);
      throw InvalidInput(file + ": has no cell field '" + name + "', which the model " + model + " needs" +
                         suggestion(name, known));
    }
    check(name, *numbers);
  }
  if (const std::vector<double>* density = material.find("density")) check("density", *density);
}

void write_material(const std::filesystem::path& path, const FittedMaterial& material) {
  std::vector<Field> fields;
  if (!material.mesh.region.empty())
    fields.push_back({"region", 1, {material.mesh.region.begin(), material.mesh.region.end()}, FieldType::int32});
  for (const auto* list : {&material.values, &material.further})
    for (const auto& [name, numbers] : *list) {
      ASPIC_CHECK(numbers.size() == material.mesh.tets.size());
      fields.push_back({name, 1, numbers});
    }
  std::vector<Field> model;
  if (!material.model.empty()) model.push_back({kModelField + material.model, 1, {1}, FieldType::int32});
  const TetMesh mesh = lower_order(material.mesh);
  write_vtu(path, rest_positions(mesh), mesh.tets, {{}, fields, model});
}

MaterialSampling sampling(const FittedMaterial& material, std::span<const Vec3d> centroids) {
  const TetLocator locator(material.mesh);
  const int count = static_cast<int>(centroids.size());
  std::vector<Located> place(centroids.size());
  parallel_chunks(count, [&](int first, int last) {
    for (int t = first; t < last; ++t) place[t] = locator.locate(centroids[t]);
  });
  Box box;
  for (const Vec3d& X : material.mesh.rest) box.add(X);
  const double tolerance = 1e-9 * norm(box.upper - box.lower);
  MaterialSampling result;
  result.is_same_mesh = count == material.mesh.tet_count();
  std::vector<char> is_taken(material.mesh.tets.size());
  for (int t = 0; t < count; ++t) {
    const int from = place[t].tet;
    result.tet.push_back(from);
    if (place[t].is_outside()) {
      ++result.outside;
      result.farthest = std::max(result.farthest, std::sqrt(place[t].squared_distance));
    }
    result.is_same_mesh &= !is_taken[from] && norm(centroid(material.mesh, from) - centroids[t]) <= tolerance;
    is_taken[from] = 1;
  }
  return result;
}

std::vector<double> sample(const FittedMaterial& material, std::span<const double> values, const TetMesh& mesh) {
  ASPIC_CHECK(values.size() == material.mesh.tets.size());
  std::vector<Vec3d> centroids;
  for (int t = 0; t < mesh.tet_count(); ++t) centroids.push_back(centroid(mesh, t));
  std::vector<double> result;
  for (const int t : sampling(material, centroids).tet) result.push_back(values[t]);
  return result;
}

}  // namespace aspic
