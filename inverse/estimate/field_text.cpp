#include "estimate/field_text.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "base/formatted.h"
#include "mesh/tet_shape.h"

namespace aspic {
namespace {

constexpr double kLittle = 0.2;  // negligible part of a sum of squares

// Zero has no sign.
std::string digits(double x, const char* format = "%.3g") { return formatted(format, x == 0 ? 0.0 : x); }

double size(const TetMesh& mesh) {
  double largest = 0;
  for (const Vec3d& x : mesh.rest)
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(x[i] - mesh.rest[0][i]));
  return largest;
}

struct Moments {  // integrals over the body
  double volume = 0, first = 0, second = 0, positive = 0 /* of the square, where f > 0 */;
};

Moments moments(const TetMesh& mesh, std::span<const double> f) {
  Moments m;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    const double v = volume(mesh, t);
    m.volume += v, m.first += v * f[t], m.second += v * f[t] * f[t];
    if (f[t] > 0) m.positive += v * f[t] * f[t];
  }
  return m;
}

std::vector<double> part_with_sign(std::span<const double> f, double sign) {
  std::vector<double> part(f.begin(), f.end());
  for (double& x : part) x = std::max(sign * x, 0.0);
  return part;
}

std::string describe_regions(const TetMesh& mesh, std::span<const double> f, double sign, double little) {
  std::map<int, Moments> regions;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    Moments& m = regions[mesh.region[t]];
    const double v = volume(mesh, t);
    m.first += v * f[t], m.second += v * f[t] * f[t];
  }
  std::string text;
  int count = 0;
  for (const auto& [label, m] : regions)
    if (sign * m.first > 0 && m.second > little) text += (count++ ? ", " : "") + std::to_string(label);
  return (count > 1 ? "regions " : "region ") + text;
}

std::string describe_sign(const TetMesh& mesh, const FitParameter& parameter, std::span<const double> f, double sign,
                          double little) {
  if (parameter.parameterization == Parameterization::regions) return describe_regions(mesh, f, sign, little);
  return describe_place(mesh, part_with_sign(f, sign));
}

std::string describe_field(const TetMesh& mesh, const FitParameter& parameter, std::span<const double> f) {
  const Moments m = moments(mesh, f);
  if (m.first * m.first > (1 - kLittle) * m.volume * m.second) return "of the whole body";
  const double sign = m.positive >= m.second / 2 ? 1 : -1;
  const double lesser = std::min(m.positive, m.second - m.positive), little = kLittle / 2 * m.second;
  const std::string join = parameter.parameterization == Parameterization::regions ? "of " : "";
  std::string text = join + describe_sign(mesh, parameter, f, sign, little);
  if (lesser > kLittle * m.second) text += " against " + describe_sign(mesh, parameter, f, -sign, little);
  return text;
}

}  // namespace

std::string describe_point(const Vec3d& x) {
  return "(" + digits(x[0]) + ", " + digits(x[1]) + ", " + digits(x[2]) + ") m";
}

std::string describe_place(const TetMesh& mesh, std::span<const double> field) {
  int peak = 0;
  double second = 0, fourth = 0, total = 0;
  for (int t = 0; t < mesh.tet_count(); ++t) {
    if (std::abs(field[t]) > std::abs(field[peak])) peak = t;
    const double v = volume(mesh, t), square = field[t] * field[t];
    total += v, second += v * square, fourth += v * square * square;
  }
  Vec3d x = centroid(mesh, peak);
  const double negligible = 1e-3 * size(mesh);
  for (int i = 0; i < 3; ++i)
    if (std::abs(x[i]) < negligible) x[i] = 0;
  const double part = fourth > 0 ? second * second / (fourth * total) : 1;
  return "around " + describe_point(x) + " (" + digits(100 * part, part < 0.1 ? "%.1g" : "%.2g") + " % of the body)";
}

std::string describe_direction(const TetMesh& mesh, const ParameterMap& map, std::span<const double> dp) {
  std::vector<std::vector<double>> fields;
  double sum = 0;
  std::vector<double> squares;
  for (int u = 0; u < static_cast<int>(map.fitted_parameters().size()); ++u) {
    fields.push_back(map.fitted_values(u, dp));
    squares.push_back(moments(mesh, fields.back()).second);
    sum += squares.back();
  }
  std::string text;
  for (size_t u = 0; u < fields.size(); ++u) {
    if (!(squares[u] > kLittle * sum)) continue;
    const FitParameter& parameter = map.fitted_parameters()[u];
    text += (text.empty() ? "" : " with ") + parameter.quantity + " " + describe_field(mesh, parameter, fields[u]);
  }
  return text;
}

}  // namespace aspic
