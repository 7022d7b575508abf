#include "pipeline/motion_scene.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "scene/material_file.h"
#include "scene/scene_model.h"
#include "scene/schema.h"
#include "scene/tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

const char* const kIntegrator = "backward_euler";

bool has(const std::vector<std::string>& names, const char* name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

void require_motion(const SceneModel& scene, const std::vector<std::string>& names, const std::string& file) {
  if (scene.options.integrator != kIntegrator)
    throw InvalidInput(file + ": integrator = '" + scene.options.integrator +
                       "'; a motion is fitted with --set time.integrator=backward_euler");
  if (scene.options.adaptive.tolerance > 0)
    throw InvalidInput(file + ": adaptive time steps; a motion is fitted with --set time.adaptive.tolerance=0");
  if (scene.model.contact)
    throw InvalidInput(file +
                       ": has contact, whose derivatives are not implemented; remove [contact] and [[obstacle]]");
  if (scene.model.bodies.size() != 1)
    throw InvalidInput(file + ": has " + std::to_string(scene.model.bodies.size()) +
                       " bodies; a motion is fitted to one, so keep only the body with the markers");
  const Value& body = scene.document.find("body")->array()[0];
  for (const auto& D : scene.model.damping) {
    const std::string name(D->name());
    if (name == "rayleigh_damping" || name == "strain_rate_damping") continue;
    const Value* list = body.find(name.starts_with("viscoelastic") ? "viscoelastic" : "muscle");
    throw error_at(list ? list->array()[0].place : body.place,
                   "a motion is fitted to a body with `damping` alone, but it has '" + name + "'; remove it");
  }
  const Value& velocity = body["velocity"];
  for (const Value& component : velocity.array())
    if (component.is_text() && has(names, "velocity"))
      throw error_at(velocity.place,
                     "velocity is a formula; 'velocity' is fitted as three numbers (try --set "
                     "velocity=[0,0,0])");
}

std::vector<double> viscosity_of(const SceneModel& scene, const Value& body) {
  Table damping = body["damping"].table();
  Value& viscosity = *damping.find("viscosity");
  if (viscosity.is_table() && viscosity.find("file"))  // the document has its name in the results
    for (const auto& [name, path] : scene.input_files)
      if (name == viscosity["file"].text()) viscosity.table().set("file", {fs::absolute(path).string(), {}});
  const Numbering& numbering = scene.model.numbering;
  SceneFiles files("", true);
  PaintedFields painted(placement_of(body), files, body["name"].text());
  const TetMesh mesh = to_user(numbering, scene.model.mesh);
  return numbering.tet.from_user(
      element_values(damping, scene_schema().key("damping", "viscosity"), {mesh, files, "viscosity", painted}));
}

bool are_equal(const std::vector<double>& values) {
  const auto [least, largest] = std::minmax_element(values.begin(), values.end());
  return *largest - *least <= 1e-12 * std::abs(*largest);
}

// Collects the overrides of the fitted scene.
class Overrides {
 public:
  Overrides(const FittedScene& scene, const MotionParameters& parameters, std::span<const double> p)
      : scene_(scene), parameters_(parameters), p_(p), values_(parameters.values(p)), list_(scene.overrides) {
    if (has(scene.names, "young") || has(scene.names, "poisson") || has(scene.names, "density")) add_material();
    if (has(scene.names, "mass_damping")) add("damping.mass", number_text(values_.mass_damping));
    if (has(scene.names, "stiffness_damping")) add("damping.stiffness", number_text(values_.stiffness_damping));
    if (has(scene.names, "viscosity")) add_viscosity();
    if (has(scene.names, "velocity")) add("velocity", text(values_.velocity));
    if (has(scene.names, "angular_velocity")) add("angular_velocity", text(values_.angular_velocity));
  }

  const std::vector<std::string>& list() const { return list_; }
  void remove_files() const {
    std::error_code error;
    for (const fs::path& file : files_) fs::remove(file, error);
  }

 private:
  void add(const std::string& key, const std::string& value) {
    list_.push_back("body." + scene_.body["name"].text() + "." + key + "=" + value);
  }
  static std::string text(const Vec3d& v) {
    return "[" + number_text(v[0]) + ", " + number_text(v[1]) + ", " + number_text(v[2]) + "]";
  }
  fs::path file(const char* name) {
    files_.push_back(fs::absolute(scene_.folder / name));
    return files_.back();
  }

  // Writes the fitted keys if that is possible, otherwise a table of all of them, or a file.
  void add_material() {
    const FittedMaterial material = fitted_material();
    const Value& table = scene_.body["material"];
    const bool is_elastic = has(scene_.names, "young") || has(scene_.names, "poisson");
    const auto is_uniform = [&](const char* name) { return are_equal(*material.find(name)); };
    const bool has_keys = !table.find("file") && (!is_elastic || table.find("young"));
    if (has_keys && (!is_elastic || (is_uniform("young") && is_uniform("poisson"))) &&
        (!has(scene_.names, "density") || is_uniform("density"))) {
      if (has(scene_.names, "young")) add("material.young", number_text(values_.young));
      if (has(scene_.names, "poisson")) add("material.poisson", number_text(values_.poisson));
      if (has(scene_.names, "density")) add("material.density", number_text(values_.density));
    } else if (std::all_of(material.values.begin(), material.values.end(),
                           [](const auto& field) { return are_equal(field.second); })) {
      std::string text = "{ model = " + toml_string(material.model);
      for (const auto& [name, values] : material.values) text += ", " + name + " = " + number_text(values[0]);
      add("material", text + " }");
    } else {
      const fs::path path = file("material.vtu");
      write_material(path, material);
      add("material", "{ file = " + toml_string(path.string()) + ", frame = \"placed\" }");
    }
  }

  FittedMaterial fitted_material() const {
    const Numbering& numbering = parameters_.model().numbering;
    FittedMaterial material{.mesh = to_user(numbering, parameters_.model().mesh),
                            .model = scene_.body["material"]["model"].text()};
    const std::vector<MaterialParameters> parameters = parameters_.material(p_);
    const auto add_field = [&](const std::string& name, auto&& quantity) {
      std::vector<double> values;
      for (const MaterialParameters& m : parameters) values.push_back(quantity(m));
      material.values.emplace_back(name, numbering.tet.to_user(values));
    };
    add_field("young", [](const MaterialParameters& m) { return m.lame.mu > 0 ? young_modulus(m.lame) : 0; });
    add_field("poisson", [](const MaterialParameters& m) { return m.lame.mu > 0 ? poisson_ratio(m.lame) : 0; });
    const MaterialInfo& info = material_info(material.model);
    for (size_t e = 0; e < info.extra.size(); ++e)
      add_field(info.extra[e].name, [e](const MaterialParameters& m) { return m.extra[e]; });
    material.values.emplace_back("density", numbering.tet.to_user(parameters_.density(p_)));
    return material;
  }

  void add_viscosity() {
    const std::vector<double> viscosity = parameters_.model().numbering.tet.to_user(parameters_.viscosity(p_));
    if (are_equal(viscosity)) return add("damping.viscosity", number_text(values_.viscosity));
    std::string text;
    for (const double eta : viscosity) text += number_text(eta) + "\n";
    const fs::path path = file("viscosity.csv");
    write_file(path, text);
    add("damping.viscosity", "{ file = " + toml_string(path.string()) + " }");
  }

  const FittedScene& scene_;
  const MotionParameters& parameters_;
  std::span<const double> p_;
  MotionValues values_;
  std::vector<std::string> list_;
  std::vector<fs::path> files_;  // temporary ones
};

}  // namespace

MotionScene load_motion_scene(const fs::path& path, const std::vector<std::string>& overrides,
                              const std::vector<std::string>& names) {
  SceneModel scene = load_scene_model(path, {.overrides = overrides});
  require_motion(scene, names, path.string());
  const Value body = scene.document.find("body")->array()[0];
  const Value& damping = body["damping"];
  MotionScene motion{.name = scene.name, .notes = scene.notes, .body = body};
  std::vector<double> viscosity = viscosity_of(scene, body);
  if (std::all_of(viscosity.begin(), viscosity.end(), [](double eta) { return eta == 0; })) viscosity.clear();
  const Vec3d velocity = body["velocity"].array()[0].is_text() ? Vec3d{} : body["velocity"].vector();
  motion.model = {.model = std::move(scene.model),
                  .start = std::move(scene.start),
                  .mass_damping = damping["mass"].number(),
                  .stiffness_damping = damping["stiffness"].number(),
                  .viscosity = std::move(viscosity),
                  .velocity = velocity,
                  .angular_velocity = body["angular_velocity"].vector()};
  motion.options = {.h = scene.options.h, .linear = scene.options.solver.linear};
  return motion;
}

void write_fitted_scene(const FittedScene& scene, const MotionParameters& parameters, std::span<const double> p) {
  const Overrides overrides(scene, parameters, p);
  const Scene fitted = load_scene(scene.source, {.overrides = overrides.list(), .allow_outside = true});
  write_inputs(fitted, scene.folder);
  write_file(scene.folder / "fitted.toml", fitted.resolved);
  overrides.remove_files();
}

}  // namespace aspic
