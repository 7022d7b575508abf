#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "capture/case_table.h"
#include "capture/data_findings.h"
#include "capture/surface_projection.h"
#include "scene/placement.h"

namespace aspic {
namespace {

constexpr double kDeep = 0.5;                       // of the body's size: a way that no poke goes
constexpr double kLoose = 0.05;                     // of the body's size: a gap at the touch that is no round-off
constexpr double kStrongest = 200, kWeakest = 0.1;  // [m/s^2] gravity that was meant

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
      if (load.tip) examine_tip(load);
      examine_gravity(load);
      examine_pressure(load);
      const bool is_loaded = load.tip || load.pressure != 0 || norm(load.gravity) > 0;
      if (!is_loaded)
        findings_.warning(where_, "has no load: no tip, no pressure, no gravity",
                          "it says nothing of the material; give its load, or take the row out");
    }
    examine_holds();
  }

 private:
  void examine_tip(const LoadCase& load) {
    const double way = load_size(load), off = surface_.nearest(load.touch.center).distance;
    if (off > size_ + 2 * load.tip->radius) return far_off(load, off);
    if (way > kDeep * size_)
      return findings_.error(
          where_,
          "the tip goes " + three_digits(way) + " m from its touch, the body is " + three_digits(size_) + " m across",
          "check units: length = \"mm\" or \"cm\"; touch and center are the same point of the tip");
    if (way == 0 && norm(load.pose.rotation) == 0)
      findings_.note(where_, "the tip is where it touched: the body stays at rest", "poke deeper, or take the row out");
    if (load.tip->radius > kDeep * size_)
      findings_.warning(where_,
                        "the radius of the tip, " + three_digits(load.tip->radius) + " m, is large beside the body, " +
                            three_digits(size_) + " m",
                        "check radius of [[tip]] and units: length");
    examine_touch(load, off);
  }

  void far_off(const LoadCase& load, double off) {
    std::string remedy = "check units: length, and that tip and mesh share one coordinate system";
    for (const auto& [factor, unit] : {std::pair{1e-3, "mm"}, {1e-2, "cm"}})
      if (surface_.nearest(factor * load.touch.center).distance < 0.2 * size_ + load.tip->radius)
        remedy = std::string("it would fit in ") + unit + ": units = { length = \"" + unit + "\" }";
    findings_.error(
        where_,
        "the tip is " + three_digits(off) + " m away from a body of " + three_digits(size_) + " m when it touches",
        remedy);
  }

  void examine_touch(const LoadCase& load, double off) {
    Tip tip = *load.tip;
    if (!(tip.stiffness > 0)) tip.stiffness = 1;
    try {
      make_probe(experiment_.mesh, surface_.triangles(), tip, load.touch);
    } catch (const InvalidInput& e) {
      findings_.error(where_, e.what(), "give touch and axis as they were when the tip touched the body at rest");
      return;
    }
    const double gap = tip.shape == TipShape::sphere ? off - tip.radius : off;
    if (tip.contact == TipContact::sliding && gap > kLoose * size_)
      findings_.warning(where_,
                        "the tip was " + three_digits(gap) + " m away from the surface at the touch, and then goes " +
                            three_digits(load_size(load)) + " m",
                        "touch is the centre of the tip (of a disc: of its flat end) when it begins to touch");
  }

  void examine_gravity(const LoadCase& load) {
    const double g = norm(load.gravity);
    if (g == 0 || (g > kWeakest && g < kStrongest)) return;
    findings_.warning(where_, "gravity is " + three_digits(g) + " m/s^2",
                      "on Earth it is 9.81; units = { gravity = \"g\" } takes multiples of that");
  }

  void examine_pressure(const LoadCase& load) {
    if (load.pressure == 0) return;
    if (load.pressed.empty())
      findings_.error(where_, "a pressure without a patch", "describe it as [[patch]] and name it in the column patch");
    if (std::abs(load.pressure) > 1e7 || std::abs(load.pressure) < 1)
      findings_.warning(where_, "the pressure is " + three_digits(load.pressure) + " Pa",
                        "soft bodies are loaded by 10 to 1e6 Pa; check units: pressure");
  }

  // Three vertices that are not on a line hold a body.
  void examine_holds() {
    const std::vector<int>& fixed = experiment_.fixed;
    const auto& X = experiment_.mesh.rest;
    double area = 0;
    for (size_t i = 2; i < fixed.size(); ++i)
      area = std::max(area, norm(cross(X[fixed[1]] - X[fixed[0]], X[fixed[i]] - X[fixed[0]])));
    if (area > 1e-6 * size_ * size_) return;
    const bool is_glued = std::all_of(experiment_.cases.begin(), experiment_.cases.end(), [](const LoadCase& load) {
      return load.tip && load.tip->contact == TipContact::bonded;
    });
    const std::string what =
        fixed.empty() ? "no vertex is fixed" : std::to_string(fixed.size()) + " vertices are fixed, all on one line";
    if (is_glued)
      return findings_.warning(data_.source.settings, what + ": only the tip holds the body, which it cannot deform",
                               "say with fixed what rested on the table: fixed = { lowest = 0.02 }");
    findings_.error(data_.source.settings, what + ": the body would be pushed away",
                    "say with fixed what rested on the table: fixed = { lowest = 0.02 }");
  }

  const DataSet& data_;
  const Experiment& experiment_;
  DataFindings& findings_;
  SurfaceProjection surface_;
  double size_;
  std::string where_;
};

}  // namespace

void diagnose_loads(const DataSet& data, DataFindings& findings) { LoadDiagnosis(data, findings).run(); }

}  // namespace aspic
