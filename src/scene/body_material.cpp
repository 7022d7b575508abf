#include "scene/body_material.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "mesh/tet_shape.h"
#include "scene/material_file.h"
#include "scene/placement.h"
#include "scene/schema.h"
#include "scene/tables.h"

namespace aspic {
namespace {

namespace fs = std::filesystem;

constexpr double kLockingPoisson = 0.45;  // above it linear tets are too stiff
constexpr double kElsewhere = 0.5;        // maximum distance in diagonals of the material's mesh

// A body without elasticity has a term of zero stiffness, so that det F is reported.
const char* const kModelOfNothing = "neo_hookean";

std::string four_digits(double length) { return formatted("%.4g", length); }

class FromScene {
 public:
  FromScene(PlacedBody& body, SceneFiles& files)
      : body_(body), files_(files), material_(body.scene.table().find("material")->table()) {}

  std::vector<double> density() { return values("density"); }

  std::vector<MaterialParameters> parameters() {
    std::vector<MaterialParameters> parameters(body_.mesh.element_count());
    if (material_.find("young")) {
      const std::vector<double> E = values("young"), nu = values("poisson");
      for (size_t t = 0; t < parameters.size(); ++t) parameters[t].lame = lame_from_young_poisson(E[t], nu[t]);
    } else if (material_.find("lambda")) {
      const std::vector<double> lambda = values("lambda"), mu = values("mu");
      for (size_t t = 0; t < parameters.size(); ++t) parameters[t].lame = checked({mu[t], lambda[t]}, t);
    } else {
      const std::vector<double> shear = values("shear"), bulk = values("bulk");
      for (size_t t = 0; t < parameters.size(); ++t) parameters[t].lame = lame_from_shear_bulk(shear[t], bulk[t]);
    }
    const MaterialInfo& info = material_info(material_.find("model")->text());
    for (size_t e = 0; e < info.extra.size(); ++e) {
      const std::vector<double> extra = values(info.extra[e].name);
      for (size_t t = 0; t < parameters.size(); ++t) parameters[t].extra[e] = extra[t];
    }
    return parameters;
  }

 private:
  std::vector<double> values(const std::string& name) {
    return element_values(material_, scene_schema().key("material", name),
                          {body_.mesh, files_, body_.name(), *body_.painted, body_.whole, &body_.groups});
  }

  Lame checked(const Lame& lame, size_t tet) const {
    if (lame.lambda > -2.0 / 3 * lame.mu) return lame;
    throw error_at(
        material_.find("lambda")->place,
        "lambda = " + number_text(lame.lambda) + " in tet " +
            std::to_string(body_.whole ? body_.whole->number_of_tet(static_cast<int>(tet)) : static_cast<int>(tet)) +
            "; must be > -2/3 mu = " + number_text(-2.0 / 3 * lame.mu));
  }

  PlacedBody& body_;
  SceneFiles& files_;
  Table& material_;
};

// The parameters of the file at the centroids of the body, in the coordinates of the file.
class FromFile {
 public:
  FromFile(PlacedBody& body, SceneFiles& files, std::vector<std::string>& notes)
      : body_(body), files_(files), table_(body.scene.table().find("material")->table()) {
    const Value name = *table_.find("file");
    place_ = name.place;
    const fs::path path = files.find(name);
    file_ = path.string();
    try {
      fitted_ = read_material(path);
    } catch (const InvalidInput& e) {
      throw error_at(place_, std::string("file = ") + toml_string(name.text()) + ": " + e.what());
    }
    choose_model();
    sampling_ = sampling(fitted_, centroids());
    refuse_if_elsewhere();
    note_differences(path.filename().string(), notes);
    check_fingerprint(table_, "hash", fingerprint_of_file(path), file_);
    table_.set("file", {files.keep(path, body.name() + ".material"), {}});
  }

  const std::string& model() const { return model_; }

  std::vector<double> density() {
    const std::vector<double>* density = fitted_.find("density");
    if (is_given(table_, "density") || !density) return FromScene(body_, files_).density();
    erase(table_, "density");  // the default would replace the file's density in the resolved scene
    return sampled(*density);
  }

  std::vector<MaterialParameters> parameters() const {
    const std::vector<double> E = sampled(*fitted_.find("young")), nu = sampled(*fitted_.find("poisson"));
    std::vector<MaterialParameters> parameters(E.size());
    for (size_t t = 0; t < E.size(); ++t) parameters[t].lame = lame_from_young_poisson(E[t], nu[t]);
    const MaterialInfo& info = material_info(model_);
    for (size_t e = 0; e < info.extra.size(); ++e) {
      const std::vector<double> extra = sampled(*fitted_.find(info.extra[e].name));
      for (size_t t = 0; t < E.size(); ++t) parameters[t].extra[e] = extra[t];
    }
    return parameters;
  }

 private:
  void choose_model() {
    const Value& model = *table_.find("model");
    const bool is_chosen = is_given(table_, "model");
    if (fitted_.model.empty()) {
      if (!is_chosen)
        throw error_at(place_, file_ + " names no model; state the model of its values (try model = " +
                                   toml_string("neo_hookean") + " beside `file`)");
      model_ = model.text();
      try {
        check_material(fitted_, model_, file_);
      } catch (const InvalidInput& e) {
        throw error_at(place_, e.what());
      }
      return;
    }
    model_ = fitted_.model;
    if (is_chosen && model.text() != model_)
      throw error_at(model.place, "model = " + toml_string(model.text()) + "; the numbers of " + file_ +
                                      " were fitted for " + model_ + " and are invalid for another model " +
                                      "(remove `model`, or fit with --model " + model.text() + ")");
    table_.set("model", {model_, {}});
  }

  std::vector<Vec3d> centroids() const {
    const std::string& frame = table_.find("frame")->text();
    const AffineMap map =
        from_placed(body_.scene, frame == "placed" ? Frame::placed : (frame == "scaled" ? Frame::scaled : Frame::mesh));
    std::vector<Vec3d> points;
    for (int t = 0; t < body_.mesh.tet_count(); ++t) points.push_back(map(centroid(body_.mesh, t)));
    return points;
  }

  static std::string text(const Vec3d& X) {
    return "(" + four_digits(X[0]) + ", " + four_digits(X[1]) + ", " + four_digits(X[2]) + ")";
  }
  static std::string text(const Box& box) { return text(box.lower) + " to " + text(box.upper); }

  void refuse_if_elsewhere() const {
    Box own, other;
    for (const Vec3d& X : fitted_.mesh.rest) own.add(X);
    for (const Vec3d& X : centroids()) other.add(X);
    const Vec3d diagonal = own.upper - own.lower;
    if (!(sampling_.farthest > kElsewhere * norm(diagonal))) return;
    const std::string& frame = table_.find("frame")->text();
    throw error_at(place_, file_ + " has a mesh from " + text(own) + "; body '" + body_.name() + "' lies from " +
                               text(other) + " in the frame '" + frame + "', up to " + four_digits(sampling_.farthest) +
                               " m away from it (try another `frame`: mesh, scaled or placed; check the units)");
  }

  void note_differences(const std::string& name, std::vector<std::string>& notes) const {
    if (sampling_.is_same_mesh) return;
    std::string note = "body '" + body_.name() + "': its " + std::to_string(body_.mesh.tet_count()) +
                       " tets are not the " + std::to_string(fitted_.mesh.tet_count()) + " of " + name +
                       "; each uses the values of the tet there that contains its centroid";
    if (sampling_.outside > 0)
      note += ", " + std::to_string(sampling_.outside) + " of the nearest one, at distances up to " +
              four_digits(sampling_.farthest) + " m away";
    notes.push_back(note);
  }

  std::vector<double> sampled(const std::vector<double>& values) const {
    std::vector<double> result;
    for (const int t : sampling_.tet) result.push_back(values[t]);
    return result;
  }

  PlacedBody& body_;
  SceneFiles& files_;
  Table& table_;
  Place place_;
  std::string file_, model_;
  FittedMaterial fitted_;
  MaterialSampling sampling_;
};

void note_locking(const std::vector<MaterialParameters>& parameters, const std::string& body,
                  std::vector<std::string>& notes) {
  double highest = -1;
  for (const MaterialParameters& p : parameters) highest = std::max(highest, poisson_ratio(p.lame));
  if (highest > kLockingPoisson + 1e-9)
    notes.push_back(
        "body '" + body + "': Poisson's ratio reaches " + number_text(std::round(1e9 * highest) / 1e9) +
        "; linear tets lock above 0.45 and deform too little: set order = 2 in the body, or material.poisson = 0.45");
}

template <class Source>
BodyMaterial material_from(Source& source, const std::string& model, const PlacedBody& body,
                           std::vector<std::string>& notes) {
  BodyMaterial material{model, {}, source.density()};
  if (body.scene["elastic"].boolean()) {
    material.parameters = source.parameters();
    if (body.mesh.mids.empty() && !body.mesh.tets.empty()) note_locking(material.parameters, body.name(), notes);
  } else {
    material.model = kModelOfNothing;
    material.parameters.resize(body.mesh.element_count());  // all stiffness is zero
  }
  return material;
}

}  // namespace

BodyMaterial body_material(PlacedBody& body, SceneFiles& files, std::vector<std::string>& notes) {
  const Value& table = body.scene["material"];
  if (table.find("file")) {
    FromFile source(body, files, notes);
    return material_from(source, source.model(), body, notes);
  }
  FromScene source(body, files);
  return material_from(source, table["model"].text(), body, notes);
}

}  // namespace aspic
