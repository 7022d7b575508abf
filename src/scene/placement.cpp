#include "scene/placement.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "scene/selection.h"
#include "scene/tables.h"

namespace aspic {
namespace {

constexpr double kRadians = std::numbers::pi / 180;  // per degree

Mat3d diagonal(const Value& value) {
  Vec3d s;
  if (value.is_array()) {
    s = value.vector();
  } else {
    s = {{value.number(), value.number(), value.number()}};
  }
  Mat3d D{};
  for (int i = 0; i < 3; ++i) D(i, i) = s[i];
  return D;
}

Mat3d matrix(const Value& rows) {
  Mat3d A;
  for (int r = 0; r < 3; ++r)
    for (int c = 0; c < 3; ++c) A(r, c) = rows.array()[r].array()[c].number();
  return A;
}

Mat3d euler(const Vec3d& degrees) {
  const Vec3d axes[] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
  Mat3d R = identity3<double>();
  for (int i = 0; i < 3; ++i) R = rotation(axes[i], kRadians * degrees[i]) * R;
  return R;
}

Mat3d rotation_of(const Value& body) {
  const Value* rotate = body.find("rotate");
  if (!rotate) return identity3<double>();
  if (const Value* angles = rotate->find("euler_deg")) return euler(angles->vector());
  return rotation((*rotate)["axis"].vector(), kRadians * (*rotate)["angle_deg"].number());
}

std::vector<Vec3d> twisted(const Value& twist, const std::vector<Vec3d>& X, const Vec3d& center,
                           const WholeBody* whole) {
  const Vec3d axis = twist["axis"].vector();
  const Vec3d a = (1 / norm(axis)) * axis;
  double low = INFINITY, high = -INFINITY;
  if (whole) {
    const auto [lowest, highest] = whole->heights(a);
    low = lowest - dot(a, center), high = highest - dot(a, center);
  } else {
    for (const Vec3d& P : X) low = std::min(low, dot(a, P - center)), high = std::max(high, dot(a, P - center));
  }
  const double rate = high > low ? kRadians * twist["angle_deg"].number() / (high - low) : 0;
  std::vector<Vec3d> x;
  for (const Vec3d& P : X) {
    const Vec3d from = P - center;
    x.push_back(center + rotation(a, rate * dot(a, from)) * from);
  }
  return x;
}

std::vector<Vec3d> displaced_by_file(Value& deform, const std::vector<Vec3d>& X, SceneFiles& files,
                                     const std::string& stem) {
  const Value name = deform["file"];
  const std::filesystem::path path = files.find(name);
  const std::vector<double> u = read_number_table(path, 3, X.size(), "a vertex", name.place);
  std::vector<Vec3d> x;
  for (size_t i = 0; i < X.size(); ++i) x.push_back(X[i] + Vec3d{{u[3 * i], u[3 * i + 1], u[3 * i + 2]}});
  check_fingerprint(deform.table(), "hash", fingerprint_of_file(path), path.string());
  deform.table().set("file", {files.keep(path, stem + ".displacement"), {}});
  return x;
}

}  // namespace

Mat3d rotation(const Vec3d& axis, double angle) {
  // Rodrigues: R = cos I + sin [a] + (1 - cos) a a'
  const Vec3d a = (1 / norm(axis)) * axis;
  const double c = std::cos(angle), s = std::sin(angle);
  Mat3d R;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) R(i, j) = (1 - c) * a[i] * a[j] + (i == j ? c : 0);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    R(k, j) += s * a[i];
    R(j, k) -= s * a[i];
  }
  return R;
}

AffineMap placement_of(const Value& body) {
  return {rotation_of(body) * diagonal(body["scale"]), body["translate"].vector()};
}

void place(const AffineMap& map, std::span<Vec3d> points) {
  for (Vec3d& X : points) X = map(X);
}

AffineMap from_placed(const Value& body, Frame frame) {
  if (frame == Frame::placed) return {};
  const AffineMap place = placement_of(body);
  // X_mesh = A^-1 (x - b), X_scaled = R' (x - b)
  const Mat3d back = frame == Frame::mesh ? inverse(place.A) : transpose(rotation_of(body));
  return {back, -1.0 * (back * place.b)};
}

std::vector<Vec3d> deformed(Value& body, const std::vector<Vec3d>& X, SceneFiles& files, const std::string& stem,
                            const WholeBody* whole) {
  Value* deform = body.table().find("deform");
  if (!deform) return X;
  const Box box = whole ? whole->box() : bounding_box(X);
  const Vec3d center = 0.5 * (box.lower + box.upper);
  if (deform->find("file")) return displaced_by_file(*deform, X, files, stem);
  if (const Value* twist = deform->find("twist")) return twisted(*twist, X, center, whole);
  std::vector<Vec3d> x;
  if (const Value* displacement = deform->find("displacement")) {
    const VectorField u(*displacement);
    for (const Vec3d& P : X) x.push_back(P + u.at(P));
    return x;
  }
  const Value* scale = deform->find("scale");
  const Mat3d F = scale ? diagonal(*scale) : matrix((*deform)["matrix"]);
  for (const Vec3d& P : X) x.push_back(center + F * (P - center));
  return x;
}

std::vector<Vec3d> velocities(const Value& body, const std::vector<Vec3d>& X, const std::vector<Vec3d>& x,
                              std::span<const double> vertex_mass) {
  const VectorField v(body["velocity"]);
  const Vec3d omega = body["angular_velocity"].vector();
  double mass = 0;
  Vec3d center{};
  for (size_t i = 0; i < x.size(); ++i) {
    mass += vertex_mass[i];
    center = center + vertex_mass[i] * x[i];
  }
  if (mass > 0) center = (1 / mass) * center;
  std::vector<Vec3d> result;
  for (size_t i = 0; i < x.size(); ++i) result.push_back(v.at(X[i]) + cross(omega, x[i] - center));
  return result;
}

VectorField::VectorField(const Value& value, ExpressionVariables variables) {
  for (const Value& v : value.array()) {
    formula_.emplace_back(v.is_text() ? v.text() : "0", variables);
    number_.push_back(v.is_text() ? NAN : v.number());
  }
}

Vec3d VectorField::at(const Vec3d& X, double t) const {
  Vec3d result;
  for (int i = 0; i < 3; ++i) result[i] = std::isnan(number_[i]) ? formula_[i].at(X, t) : number_[i];
  return result;
}

bool VectorField::depends_on_time() const {
  return std::any_of(formula_.begin(), formula_.end(), [](const Expression& f) { return f.depends_on_time(); });
}

std::function<double(double t)> function_of_time(const Value& value, const std::string& only_time) {
  const Expression formula(value.is_text() ? value.text() : number_text(value.number()),
                           ExpressionVariables::position_and_time);
  if (formula.depends_on_position()) throw error_at(value.place, only_time);
  return [formula, place = value.place](double t) {
    try {
      return formula.at({}, t);
    } catch (const InvalidInput& e) {
      throw error_at(place, e.what());
    }
  };
}

}  // namespace aspic
