#include "data/unstated_values.h"

#include <algorithm>
#include <set>

#include "data/apparent_stiffness.h"
#include "data/data_findings.h"
#include "data/surface_projection.h"

namespace aspic {
namespace {

// Fraction of the largest motion or force, used without a given standard deviation: the noise of the data sets in docs.
constexpr double kSigma = 0.01;
// Layer stiffness times the radius, over Young's modulus, of a bonded and of a sliding indenter. The second
// one gives way by 1 / 260 of the depth of a flat punch: F = 2.4 E a depth [Johnson 1985] over pi a^2 k. Chosen.
constexpr double kLayer = 1e5, kSoftLayer = 200;

}  // namespace

double layer_stiffness(const Indenter& indenter, double young) {
  return (indenter.contact == IndenterContact::bonded ? kLayer : kSoftLayer) * young / indenter.radius;
}

void choose_sigmas(DataSet& data) {
  Experiment& e = data.experiment;
  double motion = 0, force = 0, torque = 0;
  for (const LoadCase& load : e.cases) {
    for (const MarkerReading& r : load.positions)
      motion = std::max(motion, norm(r.position - position(e.markers[r.marker], e.mesh.rest)));
    if (load.force) force = std::max(force, norm(*load.force));
    if (load.torque) torque = std::max(torque, norm(*load.torque));
  }
  bool chosen[3] = {};
  const auto complete = [&](Vec3d& sd, double largest, int what) {
    for (int i = 0; i < 3; ++i)
      if (sd[i] == 0) sd[i] = largest > 0 ? kSigma * largest : 1, chosen[what] = true;
  };
  for (LoadCase& load : e.cases) {
    for (MarkerReading& r : load.positions) complete(r.sigma, motion, 0);
    if (load.force) complete(load.force_sigma, force, 1);
    if (load.torque) complete(load.torque_sigma, torque, 2);
  }
  const auto note = [&](int what, const char* name, double largest, const char* unit) {
    if (chosen[what])
      data.notes.push_back(std::string("no standard deviation of ") + name + ": using 1 % of the largest, " +
                           number_text(kSigma * largest) + " " + unit + " (deviation in capture.toml sets it)");
  };
  note(0, "positions", motion, "m");
  note(1, "forces", force, "N");
  note(2, "torques", torque, "N m");
}

void choose_layers(DataSet& data) {
  const double E = apparent_young(data.experiment).value_or(1e5);
  std::set<double> chosen;
  for (LoadCase& load : data.experiment.cases) {
    if (!load.indenter || load.indenter->stiffness > 0) continue;
    load.indenter->stiffness = layer_stiffness(*load.indenter, E);
    chosen.insert(load.indenter->stiffness);
  }
  for (const double k : chosen)
    data.notes.push_back("the layer of the tip has the stiffness " + three_digits(k) +
                         " Pa/m, far stiffer than the body, which seems to have E = " + three_digits(E) +
                         " Pa; it is fitted, too, which widens the interval of E (a rigid tip: stiffness = " +
                         three_digits(10 * k) + " in [[tip]])");
}

}  // namespace aspic
