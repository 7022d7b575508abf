#include "data/registration.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "base/formatted.h"
#include "data/closest_point_fit.h"
#include "data/rigid_motion.h"
#include "io/atomic_file.h"
#include "math/symmetric_eigen.h"
#include "mesh/box.h"
#include "model/limits.h"
#include "scene/schema_table.h"
#include "scene/toml_reader.h"

namespace aspic {
namespace {

// Points and iterations for the search among poses, and for the final one. Chosen.
constexpr size_t kFewPoints = 200, kManyPoints = 20'000;
constexpr int kSearch = 30, kFinal = 200;
// Spread across a line over the spread along it; chosen between round-off and noise.
constexpr double kCollinear = 1e-3;
constexpr double kDegrees = 180 / std::numbers::pi;

std::vector<Vec3d> thinned(std::span<const Vec3d> points, size_t most) {
  const size_t stride = (points.size() + most - 1) / most;
  std::vector<Vec3d> some;
  for (size_t i = 0; i < points.size(); i += stride) some.push_back(points[i]);
  return some;
}

void require_points(size_t count, const char* what) {
  if (count < 3)
    throw InvalidInput("registration: " + std::to_string(count) + " " + what +
                       "; a pose needs at least 3, not on one line");
}

// The 24 rotations that permute the axes.
std::vector<Mat3d> axis_rotations() {
  std::vector<Mat3d> rotations;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int signs = 0; signs < 4 && i != j; ++signs) {
        Vec3d a{}, b{};
        a[i] = (signs & 1) != 0 ? -1 : 1;
        b[j] = (signs & 2) != 0 ? -1 : 1;
        const Vec3d c = cross(a, b);
        Mat3d R;
        for (int k = 0; k < 3; ++k) R(k, 0) = a[k], R(k, 1) = b[k], R(k, 2) = c[k];
        rotations.push_back(R);
      }
  return rotations;
}

std::string turn_text(const Mat3d& R) {
  const AxisAngle turn = axis_angle_of(R);
  return formatted("%.3g deg about the direction (%.2f, %.2f, %.2f)", turn.angle * kDegrees, turn.axis[0], turn.axis[1],
                   turn.axis[2]);
}

class SurfaceRegistration {
 public:
  SurfaceRegistration(const SurfaceProjection& surface, std::span<const Vec3d> points, RegistrationKind kind)
      : surface_(surface),
        points_(thinned(points, kManyPoints)),
        few_(thinned(points, kFewPoints)),
        scales_(kind == RegistrationKind::similarity) {
    for (const Triangle& t : surface.triangles()) body_.push_back(surface.center(t));
    length_ = spread_of(body_);
  }

  Registration run() {
    const std::vector<AffineMap> guesses = initial_guesses();
    const ClosestPointFit search(surface_, few_, scales_), final(surface_, points_, scales_);
    std::vector<std::pair<double, PoseFit>> found;
    for (const AffineMap& guess : guesses) {
      const PoseFit fit = search.run(guess, kSearch);
      if (!search.is_scale_at_bound(guess, fit.map)) found.emplace_back(own_rms(fit), fit);
    }
    if (found.empty())
      throw InvalidInput(
          "registration: the points do not determine the scale; use --register rigid, with the unit of "
          "length of the points");
    double best = found[0].first;
    for (const auto& [rms, fit] : found) best = std::min(best, rms);
    const PoseFit& chosen = chosen_of(found, best);
    const PoseFit whole = final.run(chosen.map, kFinal);
    Registration result{whole.map, scale_of(whole.map), static_cast<int>(points_.size()), whole.rms, whole.largest, {}};
    add_free_motions(whole, result);
    add_other_poses(found, best, chosen, result);
    return result;
  }

 private:
  double own_rms(const PoseFit& fit) const { return fit.rms / scale_of(fit.map); }  // in the scale of the points
  // The best pose, but one near the given coordinates, the first guess, if its distance is not larger except for noise.
  const PoseFit& chosen_of(const std::vector<std::pair<double, PoseFit>>& found, double best) const {
    if (found[0].first <= kNoiseRatio * best + kExactError * spread_of(few_)) return found[0].second;
    const auto by_rms = [](const auto& a, const auto& b) { return a.first < b.first; };
    return std::min_element(found.begin(), found.end(), by_rms)->second;
  }
  bool is_as_good(double rms, double best) const { return rms <= kClearRatio * best + kExactError * spread_of(few_); }

  std::vector<AffineMap> initial_guesses() const {
    std::vector<AffineMap> guesses = {AffineMap{}};
    Vec3d of_body, of_points;
    const Mat3d body = principal_axes(covariance_of(body_), of_body);
    const Mat3d own = principal_axes(covariance_of(few_), of_points);
    const double ratio = spread_of(few_) > 0 ? length_ / spread_of(few_) : 1;
    std::vector<double> scales = {1};
    if (scales_ && (ratio < 0.7 || ratio > 1.4)) scales.push_back(ratio);
    for (const double scale : scales)
      for (const Mat3d& R : axis_rotations()) {
        AffineMap guess;
        guess.A = scale * (body * (R * transpose(own)));
        guess.b = centroid_of(body_) - guess.A * centroid_of(few_);
        guesses.push_back(guess);
      }
    for (const Mat3d& R : axis_rotations()) {  // turned by right angles in place
      AffineMap guess{R, {}};
      guess.b = centroid_of(body_) - R * centroid_of(few_);
      guesses.push_back(guess);
    }
    return guesses;
  }

  // Motions that leave the points on the surface: eigenvectors of the mean squared motion along the normals.
  void add_free_motions(const PoseFit& fit, Registration& result) const {
    Vec3d variances;
    principal_axes(covariance_of(points_), variances);
    if (variances[1] <= kCollinear * kCollinear * variances[0]) {
      result.ambiguities.push_back("the points lie on a line: the rotation about it is not determined");
      return;
    }
    const SymmetricEigen<7> e = symmetric_eigen<7>(fit.normal);
    for (int k = 0; k < 7; ++k) {
      std::array<double, 7> v{};
      std::copy_n(e.vectors.begin() + 7 * k, 7, v.begin());
      if (!scales_ && std::abs(v[6]) > 0.5) continue;
      if (e.values[k] < kOffSurface * kOffSurface) result.ambiguities.push_back(free_text(v, fit.map));
    }
  }

  std::string free_text(const std::array<double, 7>& v, const AffineMap& map) const {
    const Vec3d shift = {{v[0], v[1], v[2]}}, turn = {{v[3], v[4], v[5]}};
    const auto direction = [](const Vec3d& d) {
      const Vec3d n = (1 / norm(d)) * d;
      return formatted("(%.2f, %.2f, %.2f)", n[0], n[1], n[2]);
    };
    const Vec3d c = map(centroid_of(points_));
    const std::string center = formatted("(%.3g, %.3g, %.3g) m", c[0], c[1], c[2]);
    const std::string free = "the points stay on the surface when they ";
    if (std::abs(v[6]) > std::max(norm(shift), norm(turn))) return free + "grow or shrink: the scale is not determined";
    if (norm(shift) > norm(turn)) return free + "slide along " + direction(shift) + ": this shift is not determined";
    return free + "turn about " + direction(turn) + " through " + center + ": this rotation is not determined";
  }

  void add_other_poses(const std::vector<std::pair<double, PoseFit>>& found, double best, const PoseFit& chosen,
                       Registration& result) const {
    if (!result.ambiguities.empty()) return;  // other poses differ by these motions
    std::vector<AffineMap> listed = {chosen.map};
    for (const auto& [rms, fit] : found) {
      const auto is_same = [&, &map = fit.map](const AffineMap& other) {
        return distance(map, other) < kNegligible * spread_of(few_);
      };
      if (!is_as_good(rms, best) || std::any_of(listed.begin(), listed.end(), is_same)) continue;
      listed.push_back(fit.map);
      const Mat3d turn = rotation_of(fit.map) * transpose(rotation_of(chosen.map));
      result.ambiguities.push_back("another pose fits as well (" + three_digits(fit.rms) + " m instead of " +
                                   three_digits(chosen.rms) + " m): turned by " + turn_text(turn) +
                                   "; the points are nearly symmetric");
      if (listed.size() > 4) return;
    }
  }

  double distance(const AffineMap& a, const AffineMap& b) const {
    double sum = 0;
    for (const Vec3d& p : few_) sum += squared_norm(a(p) - b(p));
    return std::sqrt(sum / static_cast<double>(few_.size()));
  }

  const SurfaceProjection& surface_;
  std::vector<Vec3d> points_, few_, body_;
  bool scales_;
  double length_ = 0;
};

const Schema& registration_schema() {
  static const Schema schema = [] {
    Schema s;
    add_section(
        s, {"registration", "registration.toml", "Motion from the coordinates of the markers to those of the mesh."},
        {key("scale", kNumber, "scale factor about the origin", kPositive, Usual{"1.0"}),
         key("rotate", kTable, "rotation about the origin", Members{"rotate"}),
         key("translate", kNumbers, "translation", Units{"m"}, Usual{"[0.0, 0.0, 0.0]"}),
         key("rms", kNumber, "root mean square distance of the points", Units{"m"}),
         key("largest", kNumber, "largest distance of a point", Units{"m"}),
         key("points", kInteger, "number of points"), key("ambiguities", kNames, "motions that are not determined")});
    for (const Section& section : scene_schema().sections)
      if (section.name == "rotate") s.sections.push_back(section);
    for (const Key& key : scene_schema().keys)
      if (key.section == "rotate") s.keys.push_back(key);
    for (const Alternatives& a : scene_schema().alternatives)
      if (a.section == "rotate") s.alternatives.push_back(a);
    return s;
  }();
  return schema;
}

std::string vector_text(const Vec3d& v) {
  return "[" + number_text(v[0]) + ", " + number_text(v[1]) + ", " + number_text(v[2]) + "]";
}

}  // namespace

Registration register_to_surface(const SurfaceProjection& surface, std::span<const Vec3d> points,
                                 RegistrationKind kind) {
  require_points(points.size(), "points are known at rest");
  return SurfaceRegistration(surface, points, kind).run();
}

Registration register_to_targets(std::span<const Vec3d> points, std::span<const Vec3d> targets, RegistrationKind kind) {
  require_points(points.size(), "markers have both a position and a place on the mesh");
  double second = 0;
  Registration result;
  result.to_mesh = best_motion(points, targets, kind == RegistrationKind::similarity, second);
  result.scale = scale_of(result.to_mesh);
  result.points = static_cast<int>(points.size());
  for (size_t i = 0; i < points.size(); ++i) {
    const double distance = norm(result.to_mesh(points[i]) - targets[i]);
    result.rms += distance * distance / static_cast<double>(points.size());
    result.largest = std::max(result.largest, distance);
  }
  result.rms = std::sqrt(result.rms);
  if (second < kCollinear * kCollinear)
    result.ambiguities.push_back("the points lie on a line: the rotation about it is not determined");
  return result;
}

void write_registration(const std::filesystem::path& path, const Registration& r) {
  const AxisAngle turn = axis_angle_of(rotation_of(r.to_mesh));
  std::string text =
      "# Maps the coordinates of the markers to those of the mesh: scaled, then rotated, then translated.\n";
  text += "# Reuse it by registration = \"" + path.filename().string() + "\" in capture.toml.\n";
  text += "scale = " + number_text(r.scale) + "\n";
  text +=
      "rotate = { axis = " + vector_text(turn.axis) + ", angle_deg = " + number_text(turn.angle * kDegrees) + " }\n";
  text += "translate = " + vector_text(r.to_mesh.b) + "  # [m]\n";
  text += "rms = " + number_text(r.rms) + "  # root mean square distance of the points from their targets [m]\n";
  text += "largest = " + number_text(r.largest) + "  # [m]\npoints = " + std::to_string(r.points) + "\nambiguities = [";
  for (size_t i = 0; i < r.ambiguities.size(); ++i) text += (i > 0 ? ", " : "") + toml_string(r.ambiguities[i]);
  write_file(path, text + "]\n");
}

AffineMap read_registration(const std::filesystem::path& path) {
  Table document = read_toml(read_toml_text(path), path.string());
  check_and_complete(document, path.string(), registration_schema(), "registration");
  return placement_of({std::move(document), {}});
}

std::string text_of(const Registration& r) {
  std::string text = "registration of " + std::to_string(r.points) + " points: turned by " +
                     turn_text(rotation_of(r.to_mesh)) +
                     formatted(", moved by (%.4g, %.4g, %.4g) m", r.to_mesh.b[0], r.to_mesh.b[1], r.to_mesh.b[2]);
  if (std::abs(r.scale - 1) > 1e-12) text += formatted(", scaled by %.6g", r.scale);
  return text + "; distances " + three_digits(r.rms) + " m (root mean square), " + three_digits(r.largest) +
         " m (largest)";
}

}  // namespace aspic
