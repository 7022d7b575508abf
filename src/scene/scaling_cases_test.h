// A scene in chosen units, and its dimensionless results.
#pragma once
#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <ostream>

#include "scene/scene_cases_test.h"

namespace aspic::scaling {

struct Scales {
  double length = 1, modulus = 1, density = 1;

  double time() const { return length * std::sqrt(density / modulus); }
  double of(const std::string& unit) const {
    const double t = time(), energy = modulus * length * length * length;
    const std::map<std::string, double> known = {{"m", length},
                                                 {"s", t},
                                                 {"1/s", 1 / t},
                                                 {"m/s", length / t},
                                                 {"m/s^2", length / (t * t)},
                                                 {"Pa", modulus},
                                                 {"Pa s", modulus * t},
                                                 {"kg/m^3", density},
                                                 {"N/m", modulus * length},
                                                 {"N/m^3", modulus / length},
                                                 {"N", modulus * length * length},
                                                 {"J", energy},
                                                 {"deg/s", 1 / t}};
    return known.at(unit);
  }
};

inline std::ostream& operator<<(std::ostream& out, const Scales& scales) {
  return out << "length " << scales.length << ", modulus " << scales.modulus << ", density " << scales.density;
}

// "<0.4 m>" becomes 0.4 in the units of `scales`.
std::string in_units(const std::string& text, const Scales& scales);

std::string digits(double x);

inline const std::string kTime = "gravity = [0, <-9.81 m/s^2>, 0]\n[time]\nstep = <0.02 s>\nduration = <0.1 s>\n";
inline const std::string kBeam =
    "[[body]]\nname = \"beam\"\nshape = { box = { upper = [<0.4 m>, <0.1 m>, <0.1 m>], cells = [6, 2, 2] } }\n";
inline const std::string kRubber = "material = { young = <1e5 Pa>, poisson = 0.4, density = <1000 kg/m^3> }\n";
inline const std::string kWall = "[[body.pin]]\nwhere = \"X < <1e-9 m>\"\n";
inline const std::string kSagging = kBeam + kRubber + kWall;

// A case: body, loads, solver and scheme.
struct Case {
  std::string name;
  std::string options;  // after kTime
  std::string bodies = kSagging;
  std::function<void(Model&, const Scales&)> amend = {};
  bool is_sensitive = false;  // the path amplifies round-off
  std::string mesh = {};      // a file that the scene needs
  int steps = 100;            // maximum number
};
inline void PrintTo(const Case& c, std::ostream* out) { *out << c.name; }

struct Outcome {
  std::vector<std::string> status;
  std::vector<int> counts;
  std::vector<double> numbers;  // dimensionless
};

Outcome run(const Case& c, const Scales& scales);

// Returns the largest difference of the dimensionless numbers.
inline double difference(const Outcome& a, const Outcome& b) {
  double worst = 0;
  for (size_t i = 0; i < a.numbers.size(); ++i) worst = std::max(worst, std::abs(a.numbers[i] - b.numbers[i]));
  return worst;
}

}  // namespace aspic::scaling
