#include "scene/body_fibres.h"

#include <algorithm>

#include "energy/fibres.h"
#include "scene/fibre_directions.h"
#include "scene/piecewise_linear.h"
#include "scene/placement.h"
#include "scene/schema.h"
#include "scene/tables.h"

namespace aspic {
namespace {

// One table of a body and the name of its term.
class BodyFibre {
 public:
  BodyFibre(PlacedBody& body, Value& scene, std::string name, const FibreScope& scope)
      : body_(body), scene_(scene), name_(std::move(name)), scope_(scope) {}

  std::string law() const { return scene_["law"].text(); }
  const Value& operator[](const char* key) const { return scene_[key]; }
  bool has(const char* key) const { return scene_.find(key) != nullptr; }
  FibrePlace place(const Model& model, const std::string& name = "") const {
    return {name.empty() ? name_ : name, model.mesh, body_.first_tet};
  }
  std::string suffix() const { return name_.substr(std::min(name_.size(), name_.find('_'))); }

  static std::string missing(std::string_view key, std::string text) {
    return text.append(" needs `").append(key) + '`';
  }
  static std::string unused(std::string_view key, const Value& value, const std::string& cause) {
    return std::string(key).append(" = ").append(inline_toml(value)) + "; " + cause + " does not use it (remove it)";
  }

  // Removes the defaults of other keys among `all`, and refuses those that are given or missing.
  void need_only(const std::vector<std::string>& needed, const std::vector<std::string>& all,
                 const std::string& cause) {
    Table& table = scene_.table();
    for (const std::string& key : all) {
      const bool is_needed = std::find(needed.begin(), needed.end(), key) != needed.end();
      const Value* value = table.find(key);
      if (is_needed && !value) throw error_at(scene_.place, missing(key, cause));
      if (!is_needed && is_given(table, key)) throw error_at(value->place, unused(key, *value, cause));
      if (!is_needed) erase(table, key);
    }
  }

  std::vector<FibreDirections> directions() const {
    return fibre_directions({body_, scene_, scope_.up, scope_.files, stem() + ".directions"});
  }
  // Exports the directions of the first family of each body as the fields fibre_x, fibre_y, fibre_z.
  void export_directions(const std::vector<FibreDirections>& directions, Model& model) const {
    const auto component = [&](int r) -> std::vector<double>& {
      const std::string name = std::string("fibre_") + static_cast<char>('x' + r);
      for (auto& [known, values] : model.tet_fields)
        if (known == name) return values;
      return model.tet_fields.emplace_back(name, std::vector<double>(model.mesh.tets.size(), 0.0)).second;
    };
    const int first = body_.first_tet;
    if (component(0)[first] != 0 || component(1)[first] != 0 || component(2)[first] != 0) return;
    for (int t = 0; t < body_.mesh.tet_count(); ++t) {
      const int at = first + body_.numbering.tet.from_user(t);
      Vec3d sum{};
      for (int q = 0; q < fibre_point_count(body_.mesh, t); ++q) sum = sum + directions[t][q];
      const double length = norm(sum);
      for (int r = 0; r < 3 && length > 0; ++r) component(r)[at] = sum[r] / length;
    }
  }

  // Values of a key, one per tet of the user.
  std::vector<double> values(const char* section, const char* key) const {
    return element_values(scene_.table(), scene_schema().key(section, key),
                          {body_.mesh, scope_.files, stem(), *body_.painted, nullptr, &body_.groups});
  }

  // of_user(t): the fibre of a tet of the user. Returns them in the order of the model.
  template <class OfUser>
  auto in_model(const OfUser& of_user) const {
    std::vector<decltype(of_user(0))> fibres(body_.mesh.tets.size());
    for (int t = 0; t < body_.mesh.tet_count(); ++t) fibres[body_.numbering.tet.from_user(t)] = of_user(t);
    return fibres;
  }

 private:
  std::string stem() const { return body_.name() + "." + name_; }

  PlacedBody& body_;
  Value& scene_;
  std::string name_;
  const FibreScope& scope_;
};

void add_fibre(BodyFibre fibre, Model& model) {
  const std::string law = fibre.law();
  std::vector<std::string> needed = {"exponent", "dispersion"};
  if (law == "guccione") needed = {"along", "across", "shear"};
  if (law == "weiss") needed = {"exponent", "straight_stretch", "straight_stiffness"};
  fibre.need_only(needed,
                  {"exponent", "dispersion", "along", "across", "shear", "straight_stretch", "straight_stiffness"},
                  "law = " + toml_string(law));
  const std::vector<FibreDirections> directions = fibre.directions();
  fibre.export_directions(directions, model);
  const auto values = [&](const char* key) { return fibre.values("fibre", key); };
  const auto stiffness = values("stiffness"), a = values(needed[0].c_str()), b = values(needed[1].c_str());
  const FibrePlace place = fibre.place(model);
  if (law == "gasser") {
    const std::vector<Fibre> list = fibre.in_model([&](int t) {
      return Fibre{directions[t], stiffness[t], a[t], b[t]};
    });
    return model.loads.push_back(make_fibres(place, list));
  }
  const auto c = values(needed[2].c_str());
  if (law == "guccione") {
    const std::vector<GuccioneFibre> list = fibre.in_model([&](int t) {
      return GuccioneFibre{directions[t], stiffness[t], a[t], b[t], c[t]};
    });
    return model.loads.push_back(make_fibres(place, list));
  }
  const std::vector<WeissFibre> list = fibre.in_model([&](int t) {
    return WeissFibre{directions[t], stiffness[t], a[t], b[t], c[t]};
  });
  for (const WeissFibre& f : list)
    if (f.exponent * (f.straight_stretch - 1) > kMostWeissStiffening)
      throw error_at(fibre["exponent"].place,
                     "exponent (straight_stretch - 1) = " + number_text(f.exponent * (f.straight_stretch - 1)) +
                         "; must be at most " + number_text(kMostWeissStiffening) + " (fibres straighten earlier)");
  model.loads.push_back(make_fibres(place, list));
}

std::function<double(double t)> level_over_time(const Value& value) {
  if (!value.is_array()) return function_of_time(value, "activation: its formula may use only t");
  PiecewiseLinear<double> level;
  for (const Value& k : value.array()) {
    level.times.push_back(k["time"].number());
    level.values.push_back(k["level"].number());
  }
  return [level](double t) { return level.at(t); };
}

// Activations outside 0 to 1 throw InvalidInput, possibly long after the scene was read.
Activation activation_of(const Value& value) {
  const auto of_time = level_over_time(value);
  const Activation checked = [of_time, place = value.place](double time) {
    const double a = of_time(time);
    if (!(a >= 0 && a <= 1))
      throw error_at(place, "activation = " + number_text(a) + " at t = " + number_text(time) +
                                "; must be >= 0 and <= 1 (try min(1, max(0, ...)))");
    return a;
  };
  checked(0);  // already where the scene is read
  return checked;
}

void add_muscle(BodyFibre muscle, Model& model) {
  const bool is_tension = muscle.law() == "tension", is_slowed = muscle.has("max_velocity");
  muscle.need_only(is_tension ? std::vector<std::string>{} : std::vector<std::string>{"optimal_stretch"},
                   {"optimal_stretch"}, "law = " + toml_string(muscle.law()));
  if (is_tension) muscle.need_only({}, {"max_velocity"}, "law = \"tension\"");
  const std::vector<std::string> hill = {"curvature", "lengthening"};
  muscle.need_only(is_slowed ? hill : std::vector<std::string>{}, hill, "a muscle without max_velocity");
  const std::vector<FibreDirections> directions = muscle.directions();
  muscle.export_directions(directions, model);
  const auto values = [&](const char* key) { return muscle.values("muscle", key); };
  const auto strength = values("strength");
  const Activation activation = activation_of(muscle["activation"]);
  if (is_tension) {
    const std::vector<TensionFibre> list = muscle.in_model([&](int t) {
      return TensionFibre{directions[t], strength[t]};
    });
    return model.loads.push_back(make_muscle(muscle.place(model), list, activation));
  }
  const auto optimal = values("optimal_stretch");
  const std::vector<MuscleFibre> list = muscle.in_model([&](int t) {
    return MuscleFibre{directions[t], strength[t], optimal[t]};
  });
  model.loads.push_back(make_muscle(muscle.place(model), list, activation));
  if (!is_slowed) return;
  const auto velocity = values("max_velocity"), curvature = values("curvature"), lengthening = values("lengthening");
  const std::vector<MuscleVelocity> slowed = muscle.in_model([&](int t) {
    return MuscleVelocity{{directions[t], strength[t], optimal[t]}, velocity[t], curvature[t], lengthening[t]};
  });
  model.damping.push_back(
      make_muscle_velocity(muscle.place(model, "muscle_velocity" + muscle.suffix()), slowed, activation));
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
        (section == "fibre" ? add_fibre : add_muscle)(BodyFibre(body, scene, name, scope), model);
      }
    }
  }
}

}  // namespace aspic
