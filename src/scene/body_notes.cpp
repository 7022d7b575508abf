#include "scene/body_notes.h"

#include <algorithm>
#include <cmath>

#include "energy/tet_elasticity.h"
#include "mesh/components.h"
#include "mesh/elements.h"
#include "mesh/generators.h"
#include "scene/placement.h"

namespace aspic {
namespace {

constexpr double kFarFromOrigin = 1e8;  // in sizes of the body; half of the 16 digits of a position are then lost
constexpr double kCrushed = 3;          // rho g H / E: strain at the bottom of a column under its own weight
constexpr double kDiamond = 1.2e12;     // [Pa]
constexpr double kSoft = 1e7;           // [Pa] above it few bodies are soft
constexpr double kSoftest = 1;          // [Pa] below it no body is a solid
constexpr double kLarge = 10;           // [m] above it, lengths were possibly meant in millimeters

void note_inverted(const PlacedBody& body, std::vector<std::string>& notes) {
  const TetMesh start{body.start, body.mesh.tets, {}};
  int count = 0;
  for (int t = 0; t < start.tet_count(); ++t)
    if (!(volume(start, t) > 0)) ++count;
  if (count > 0 && body.scene["elastic"].boolean())
    notes.push_back("body '" + body.name() + "': " + std::to_string(count) +
                    " tets are inverted or flat at the start; a flat shape may be in equilibrium and stay "
                    "so (perturb it with a small deform.displacement)");
}

// Far from the origin, differences of positions lose their last digits.
void note_lost_digits(const PlacedBody& body, std::vector<std::string>& notes) {
  const Box box = bounding_box(body.start);
  double far = 0, extent = 0;
  for (int i = 0; i < 3; ++i) {
    far = std::max({far, std::abs(box.lower[i]), std::abs(box.upper[i])});
    extent = std::max(extent, box.upper[i] - box.lower[i]);
  }
  if (far > kFarFromOrigin * extent)
    notes.push_back("body '" + body.name() + "' is " + number_text(extent) + " m large and " + number_text(far) +
                    " m from the origin: its strains have few exact digits (translate it " + "nearer)");
}

struct Means {
  double young = 0, density = 0;  // by volume [Pa], [kg/m^3]
};

Means means(const TetMesh& mesh, const BodyMaterial& material) {
  Means sum;
  double whole = 0;
  for (int t = 0; t < mesh.element_count(); ++t) {
    const double part = element_volume(mesh, t);
    whole += part;
    sum.young += part * young_modulus(material.parameters[t].lame);
    sum.density += part * material.density[t];
  }
  return {sum.young / whole, sum.density / whole};
}

// Returns the extent along `direction`, times the length of `direction`.
double extent(const std::vector<Vec3d>& X, const Vec3d& direction) {
  double low = INFINITY, high = -INFINITY;
  for (const Vec3d& x : X) low = std::min(low, dot(x, direction)), high = std::max(high, dot(x, direction));
  return high - low;
}

// Suggests a change that multiplies the stiffness, by the keys of the material.
std::string stiffness_remedy(const PlacedBody& body, const Means& mean, double factor) {
  const Value& material = body.scene["material"];
  if (material.find("file"))
    return "multiply the moduli in " + toml_string(material["file"].text()) + " by " + three_digits(factor);
  if (material.find("young")) return "set material.young = " + three_digits(factor * mean.young);
  std::string text;
  for (const char* key : {"lambda", "mu", "shear", "bulk"}) {
    const Value* modulus = material.find(key);
    if (!modulus) continue;
    const std::string name = "material." + std::string(key);
    text += text.empty() ? "" : " and ";
    text += modulus->is_number() ? "set " + name + " = " + three_digits(factor * modulus->number())
                                 : "multiply " + name + " by " + three_digits(factor);
  }
  return text;
}

// Suggests a change that makes Poisson's ratio nonnegative.
std::string poisson_remedy(const Value& material) {
  if (material.find("poisson")) return "poisson = 0 or more";
  if (material.find("lambda")) return "lambda = 0 or more";
  const Value* shear = material.find("shear");
  if (!shear) return "a Poisson's ratio of 0 or more in " + toml_string(material["file"].text());
  return "bulk = " + (shear->is_number() ? number_text(2.0 / 3 * shear->number()) : "2/3 shear") + " or more";
}

void note_weight(const PlacedBody& body, const Means& mean, const Vec3d& gravity, std::vector<std::string>& notes) {
  const double strain = mean.density * extent(body.mesh.rest, gravity) / mean.young;
  if (!(strain > kCrushed)) return;
  const std::string crushed = "body '" + body.name() +
                              "': its weight crushes it: density * gravity * height / young = " + three_digits(strain) +
                              ", where 1 is already large; if ";
  const Box box = bounding_box(body.mesh.rest);
  const double size = std::max({box.upper[0] - box.lower[0], box.upper[1] - box.lower[1], box.upper[2] - box.lower[2]});
  if (size > kLarge && strain < 1e3) {
    notes.push_back(crushed + "its " + three_digits(size) + " m are millimeters, set body." + body.name() +
                    ".scale = 0.001");
    return;
  }
  double factor = 1e3;
  while (factor < 1e9 && strain > factor) factor *= 1e3;
  const char* unit = factor == 1e3 ? "kPa" : factor == 1e6 ? "MPa" : "GPa";
  notes.push_back(crushed + three_digits(mean.young) + " is in " + unit + ", " + stiffness_remedy(body, mean, factor));
}

void note_softness(const PlacedBody& body, const Means& mean, std::vector<std::string>& notes) {
  if (!(mean.young > 0 && mean.young < kSoftest)) return;
  const std::string young = three_digits(mean.young);
  notes.push_back("body '" + body.name() + "': " + young + " Pa is softer than any solid (jelly: 5e3 Pa); if " + young +
                  " is in MPa, " + stiffness_remedy(body, mean, 1e6));
}

void note_diamond(const PlacedBody& body, const Means& mean, std::vector<std::string>& notes) {
  if (!(mean.young > kDiamond)) return;
  const Box box = bounding_box(body.mesh.rest);
  const double length = norm(box.upper - box.lower);
  double factor = 1e3;
  while (factor < 1e9 && mean.young / factor > kSoft) factor *= 1e3;
  notes.push_back("body '" + body.name() + "': stiffer than diamond (1.2e12 Pa), it vibrates at " +
                  three_digits(std::sqrt(mean.young / mean.density) / (2 * length)) + " Hz; if " +
                  three_digits(mean.young) + " Pa is " + three_digits(factor) + " times too large, " +
                  stiffness_remedy(body, mean, 1 / factor));
}

// Checks the sign of the energy at a thousandth and at a thousand times the size.
void note_unbounded(const PlacedBody& body, const BodyMaterial& material, std::vector<std::string>& notes) {
  const auto least = std::min_element(material.parameters.begin(), material.parameters.end(),
                                      [](auto& a, auto& b) { return poisson_ratio(a.lame) < poisson_ratio(b.lame); });
  if (least == material.parameters.end() || !(poisson_ratio(least->lame) < 0)) return;
  TetMesh tet = make_box({{0, 0, 0}}, {{1, 1, 1}}, {1, 1, 1});
  tet.tets.resize(1);
  const auto V = make_tet_elasticity(material.model, tet, 0, {&*least, 1});
  for (const double size : {1e-3, 1e3}) {
    std::vector<double> x;
    for (const Vec3d& X : tet.rest)
      for (int r = 0; r < 3; ++r) x.push_back(size * X[r]);
    if (!(V->value(x) < 0)) continue;
    notes.push_back("body '" + body.name() + "': with poisson = " + number_text(poisson_ratio(least->lame)) +
                    " the energy of " + material.model + " has no minimum: a body that is " +
                    (size < 1 ? "squeezed" : "stretched") + " far enough never recovers (" +
                    poisson_remedy(body.scene["material"]) + ", or model = \"stvk\")");
    return;
  }
}

}  // namespace

void note_start(const PlacedBody& body, std::vector<std::string>& notes) {
  note_inverted(body, notes);
  note_lost_digits(body, notes);
}

void note_stiffness(const PlacedBody& body, const BodyMaterial& material, const Vec3d& gravity, bool has_obstacles,
                    std::vector<std::string>& notes) {
  if (!body.scene["elastic"].boolean() || body.mesh.tets.empty()) return;
  const Means mean = means(body.mesh, material);
  const bool is_held = body.scene.find("pin") || body.scene.find("spring");
  const bool shows_weight = (is_held || has_obstacles) && dot(gravity, gravity) > 0;  // else it falls or floats
  shows_weight ? note_weight(body, mean, gravity, notes) : note_softness(body, mean, notes);
  note_diamond(body, mean, notes);
  note_unbounded(body, material, notes);
}

void note_parts(const PlacedBody& body, const Model& model, std::vector<std::string>& notes) {
  const std::vector<std::vector<int>> parts = tet_components(body.mesh);
  if (parts.size() < 2) return;
  std::vector<char> is_pinned(model.mesh.vertex_count(), 0);
  for (const Pin& pin : model.pins)
    for (const int v : pin.vertices)
      if (v < model.mesh.vertex_count()) is_pinned[v] = 1;
  std::vector<int> loose;  // the first tet of each
  for (const std::vector<int>& part : parts) {
    const bool is_held = std::any_of(part.begin(), part.end(), [&](int t) {
      const Tet& corners = body.mesh.tets[t];
      return std::any_of(corners.begin(), corners.end(), [&](int v) { return is_pinned[body.model_vertex(v)] != 0; });
    });
    if (!is_held) loose.push_back(part.front());
  }
  std::string note =
      "body '" + body.name() + "': its mesh has " + std::to_string(parts.size()) + " parts that share no vertex";
  if (!loose.empty() && loose.size() < parts.size())
    note += "; no pin holds " + std::to_string(loose.size()) + " of them (the first holds tet " +
            std::to_string(loose.front()) + ")";
  notes.push_back(note + "; for one body join them in the source model, or merge duplicate vertices with " +
                  "--repair");
}

}  // namespace aspic
