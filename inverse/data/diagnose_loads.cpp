#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/error.h"
#include "data/case_table.h"
#include "data/data_findings.h"
#include "data/surface_projection.h"
#include "data/units.h"
#include "mesh/box.h"
#include "model/limits.h"
#include "scene/placement.h"

namespace aspic {
namespace {

// Limits of findings are chosen: they decide about messages and refusals, not about results.
constexpr double kDeep = 0.5;        // fraction of the body's size; deeper indentations are implausible
constexpr double kHuge = 100;        // fraction of the body's size; larger radii are in another unit
constexpr double kTurned = 1;        // [rad] implausible rotation of a bonded indenter
constexpr double kBackwards = -0.5;  // cosine between the indenter's axis and the direction into the body
constexpr double kCoarse = 4;        // ratio of surface edges to the indenter's radius that is too coarse

class LoadDiagnosis {
 public:
  LoadDiagnosis(const DataSet& data, DataFindings& findings)
      : data_(data),
        experiment_(data.experiment),
        findings_(findings),
        surface_(experiment_.mesh),
        size_(size_of(experiment_.mesh)) {}

  void run() {
    for (size_t c = 0; c < experiment_.cases.size(); ++c) {
      const LoadCase& load = experiment_.cases[c];
      where_ = data_.source.load_case(static_cast<int>(c)) + " (" + load.name + ")";
      if (load.indenter) examine_indenter(load);
      if (load.grip) examine_grip(load);
      examine_gravity(load);
      examine_pressure(load);
      // A mesh under gravity is itself under load.
      const bool has_gravity = norm(load.gravity) > 0 || experiment_.scan_gravity;
      if (!load.indenter && !load.grip && load.pressure == 0 && !has_gravity)
        findings_.warning(where_, "has no load: no indenter, no grip, no pressure, no gravity",
                          "it has no information about the material; give its load, or remove the row");
    }
    examine_holds();
  }

 private:
  void examine_indenter(const LoadCase& load) {
    const double way = load_size(load), off = surface_.nearest(load.touch.center).distance;
    if (off > size_ + 2 * load.indenter->radius) return far_off(load, off);
    if (way > kDeep * size_)
      return findings_.error(
          where_,
          "the indenter moves " + three_digits(way) + " m from its touch in a body of " + three_digits(size_) + " m",
          "check units: length = \"mm\" or \"cm\"; touch and center are the same point of the indenter");
    if (way == 0 && norm(load.pose.rotation) == 0)
      findings_.note(where_, "the indenter is at its touch: the body stays at rest", "poke deeper, or remove the row");
    if (load.indenter->radius > kHuge * size_)
      return findings_.error(where_,
                             "the radius of the indenter, " + three_digits(load.indenter->radius) +
                                 " m, is far larger than the body, " + three_digits(size_) + " m",
                             "correct radius of [[tip]], or units: length");
    if (load.indenter->radius > kDeep * size_)
      findings_.warning(where_,
                        "the radius of the indenter, " + three_digits(load.indenter->radius) +
                            " m, is large relative to the body, " + three_digits(size_) + " m",
                        "check radius of [[tip]] and units: length");
    examine_turn("indenter", "the touch", norm(load.pose.rotation));
    examine_touch(load, off);
    examine_resolution(load);
  }

  void examine_grip(const LoadCase& load) {
    const double way = norm(load.grip->displacement);
    if (way > size_)
      findings_.error(where_, "the grip moves " + three_digits(way) + " m on a body of " + three_digits(size_) + " m",
                      "check units: length = \"mm\" or \"cm\"; move_x, move_y, move_z are a displacement from rest");
    else if (load_size(load) == 0)
      findings_.note(where_, "the grip is where it was at rest", "move it, or remove the row");
    examine_turn("grip", "rest", norm(load.grip->rotation));
  }

  void examine_turn(const std::string& what, const std::string& since, double turn) {
    const std::string finding = "the " + what + " rotates by " + three_digits(turn) + " rad since " + since;
    if (turn > 2 * std::numbers::pi)
      return findings_.error(where_, finding, "it would fit in degrees: units = { angle = \"deg\" }");
    if (turn > kTurned)
      findings_.warning(where_, finding, "rotation_x, _y, _z are a rotation vector in rad: check units: angle");
  }

  // Forces of an indenter smaller than the triangles depend on the mesh.
  void examine_resolution(const LoadCase& load) {
    if (reported_coarse_) return;
    const SurfacePoint near = surface_.nearest(load.touch.center).point;
    const auto& X = experiment_.mesh.rest;
    double edge = 0;
    for (int i = 0; i < 3; ++i) edge = std::max(edge, norm(X[near.vertices[i]] - X[near.vertices[(i + 1) % 3]]));
    if (edge <= kCoarse * load.indenter->radius) return;
    reported_coarse_ = true;
    findings_.warning(where_,
                      "the indenter of radius " + three_digits(load.indenter->radius) +
                          " m is small relative to the edges of the surface triangles, " + three_digits(edge) +
                          " m long",
                      "its forces depend on the mesh: use one with edges no longer than the width of the indenter");
  }

  void far_off(const LoadCase& load, double off) {
    std::string remedy = "check units: length, and that indenter and mesh share one coordinate system";
    for (const auto& [factor, unit] : {std::pair{1e-3, "mm"}, {1e-2, "cm"}})
      if (surface_.nearest(factor * load.touch.center).distance < 0.2 * size_ + load.indenter->radius)
        remedy = std::string("it would fit in ") + unit + ": units = { length = \"" + unit + "\" }";
    findings_.error(
        where_,
        "the indenter is " + three_digits(off) + " m away from a body of " + three_digits(size_) + " m when it touches",
        remedy);
  }

  void examine_touch(const LoadCase& load, double off) {
    const Vec3d axis = (1 / norm(load.touch.axis)) * load.touch.axis;
    if (-dot(axis, surface_.nearest(load.touch.center).normal) < kBackwards)
      return findings_.error(where_, "the axis of the indenter points out of the body",
                             "axis_x, axis_y, axis_z point into the body: change their signs, or leave "
                             "them blank");
    Indenter indenter = *load.indenter;
    if (!(indenter.stiffness > 0)) indenter.stiffness = 1;
    try {
      make_probe(experiment_.mesh, surface_.triangles(), indenter, load.touch);
    } catch (const InvalidInput& e) {
      findings_.error(where_, e.what(), "give touch and axis at the moment when the indenter touched the body at rest");
      return;
    }
    const double gap = indenter.shape == IndenterShape::sphere ? off - indenter.radius : off;
    if (indenter.contact == IndenterContact::sliding && gap > std::max(kNegligible * size_, load_size(load)))
      return findings_.error(where_,
                             "the indenter does not touch the body: it was " + three_digits(gap) +
                                 " m from the surface at the touch, and moves " + three_digits(load_size(load)) + " m",
                             "touch is the center of the indenter (of a disc: of its flat end) at first contact");
    if (indenter.contact == IndenterContact::sliding && gap > kNegligible * size_)
      findings_.warning(where_,
                        "the indenter was " + three_digits(gap) + " m from the surface at the touch, and then moves " +
                            three_digits(load_size(load)) + " m",
                        "touch is the center of the indenter (of a disc: of its flat end) at first contact");
  }

  void examine_gravity(const LoadCase& load) {
    const double g = norm(load.gravity);
    if (g == 0 || (g > kStandardGravity / kUnlike && g < kStandardGravity * kUnlike)) return;
    findings_.warning(where_, "gravity is " + three_digits(g) + " m/s^2",
                      "on Earth it is 9.81; units = { gravity = \"g\" } reads multiples of it");
  }

  void examine_pressure(const LoadCase& load) {
    if (load.pressure == 0) return;
    if (load.pressed.empty())
      findings_.error(where_, "a pressure without a patch", "describe it as [[patch]] and name it in the column patch");
    if (std::abs(load.pressure) > 1e7 || std::abs(load.pressure) < 1)
      findings_.warning(where_, "the pressure is " + three_digits(load.pressure) + " Pa",
                        "typical pressures on soft bodies are 10 to 1e6 Pa; check units: pressure");
  }

  // Three vertices that are not collinear hold a body.
  void examine_holds() {
    const std::vector<int>& fixed = experiment_.fixed;
    if (fixed.size() == experiment_.mesh.rest.size())
      return findings_.error(data_.source.settings, "all vertices are fixed: nothing can move",
                             "fix only the part on the table: fixed = { lowest = 0.02 }");
    const auto& X = experiment_.mesh.rest;
    double area = 0;
    for (size_t i = 2; i < fixed.size(); ++i)
      area = std::max(area, norm(cross(X[fixed[1]] - X[fixed[0]], X[fixed[i]] - X[fixed[0]])));
    if (area > 1e-6 * size_ * size_) return;
    const bool is_glued = std::all_of(experiment_.cases.begin(), experiment_.cases.end(), [](const LoadCase& load) {
      return load.grip || (load.indenter && load.indenter->contact == IndenterContact::bonded);
    });
    const bool is_pulled = std::any_of(experiment_.cases.begin(), experiment_.cases.end(), [](const LoadCase& load) {
      return load.pressure != 0 || norm(load.gravity) > 0;
    });
    const std::string what =
        fixed.empty() ? "no vertex is fixed" : std::to_string(fixed.size()) + " vertices are fixed, all on one line";
    if (is_glued && is_pulled)
      return findings_.warning(data_.source.settings, what + ": only the indenter or the grip holds the body",
                               "fix the part on the table: fixed = { lowest = 0.02 }");
    findings_.error(
        data_.source.settings,
        what + (is_glued ? ": the body would follow the indenter or the grip" : ": the body would be pushed away"),
        "fix the part on the table: fixed = { lowest = 0.02 }");
  }

  const DataSet& data_;
  const Experiment& experiment_;
  DataFindings& findings_;
  SurfaceProjection surface_;
  double size_;
  std::string where_;
  bool reported_coarse_ = false;
};

}  // namespace

void diagnose_loads(const DataSet& data, DataFindings& findings) { LoadDiagnosis(data, findings).run(); }

}  // namespace aspic
