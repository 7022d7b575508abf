#include <algorithm>
#include <cmath>
#include <map>

#include "capture/apparent_stiffness.h"
#include "capture/case_table.h"
#include "capture/data_findings.h"
#include "capture/units.h"
#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kSoftestPoked = 50, kStiffestPoked = 1.5e7;  // [Pa] Young's moduli of bodies that one pokes
constexpr double kUnlike = 30;                         // ratio of apparent moduli within one body that is no tissue's
constexpr double kStriking = 2.5;                      // and one that a wrong force or an inclusion has
constexpr double kSamePlace = 0.1, kSameDepth = 0.05;  // of pokes that are one, relative to the radius and the depth
constexpr double kOtherForce = 0.2, kOtherDeviations = 4;  // that forces of one poke should not differ by
constexpr double kFalling = 0.8;                        // a force that falls below this share of the last, going deeper
constexpr double kLargest = 1e9, kFinestForce = 1e-12;  // [N] of bodies that one pokes, and of their deviations
constexpr int kEnough = 6;                              // forces that tell how a gauge rounds

class ForceDiagnosis {
 public:
  ForceDiagnosis(const DataSet& data, DataFindings& findings)
      : data_(data), cases_(data.experiment.cases), findings_(findings) {}

  void run() {
    examine_missing();
    if (!examine_readings()) return;
    examine_signs();
    examine_size();
    examine_rounding();
    examine_groups();
    examine_repetitions();
    examine_falling();
  }

 private:
  std::string where(size_t c) const {
    return data_.source.load_case(static_cast<int>(c)) + " (" + cases_[c].name + ")";
  }

  void examine_missing() {
    std::vector<size_t> without;
    bool has_force = false, has_other = false;
    for (size_t c = 0; c < cases_.size(); ++c) {
      const LoadCase& load = cases_[c];
      has_force |= load.force.has_value() || load.torque.has_value();
      has_other |= load.pressure != 0 || norm(load.gravity) > 0;
      if (load.tip && !load.force && !load.torque) without.push_back(c);
    }
    if (!has_force && !has_other)
      return findings_.warning(data_.source.cases,
                               "there is no force at all: only ratios of stiffness can be known, not how stiff the "
                               "body is",
                               "measure at least one force, or a case under gravity or pressure");
    if (!without.empty() && has_force)
      findings_.note(where(without.front()),
                     "is one of " + std::to_string(without.size()) + " pokes without a force (of " +
                         std::to_string(cases_.size()) + " cases)",
                     "its motion is fitted all the same");
  }

  bool examine_readings() {
    size_t zero = 0, measured = 0;
    for (size_t c = 0; c < cases_.size(); ++c) {
      const LoadCase& load = cases_[c];
      if (!load.force) continue;
      const Vec3d& sd = load.force_deviation;
      if (!(norm(*load.force) < kLargest))
        return refuse(where(c), "the force is larger than " + three_digits(kLargest) + " N",
                      "correct it, or leave it blank");
      if (std::min({sd[0], sd[1], sd[2]}) < kFinestForce)
        return refuse(where(c),
                      "the force has a standard deviation of " + three_digits(std::min({sd[0], sd[1], sd[2]})) +
                          " N: no gauge is so exact",
                      "check the unit of force_sd; leave it blank for 1 % of the largest force");
      if (!load.tip || load_size(load) == 0) continue;
      ++measured;
      zero += norm(*load.force) == 0;
    }
    if (zero > 0 && zero == measured)
      findings_.error(data_.source.cases, "all forces are 0, though the tip goes into the body",
                      "leave them blank if none was measured");
    return true;
  }

  bool refuse(const std::string& where, const std::string& what, const std::string& remedy) {
    findings_.error(where, what, remedy);
    return false;
  }

  // The tip pushes the body the way it goes.
  void examine_signs() {
    std::vector<size_t> against;
    int measured = 0;
    for (size_t c = 0; c < cases_.size(); ++c) {
      if (!cases_[c].tip || !cases_[c].force) continue;
      const Vec3d way = cases_[c].pose.center - cases_[c].touch.center;
      const double along = dot(way, *cases_[c].force);
      ++measured;
      const double noise = 3 * deviation_along(cases_[c]);
      if (along < -norm(way) * std::max(0.1 * norm(*cases_[c].force), noise)) against.push_back(c);
    }
    if (against.empty()) return;
    if (2 * static_cast<int>(against.size()) > measured)
      return findings_.error(where(against.front()),
                             "the force points against the way of the tip, here and in " +
                                 std::to_string(against.size() - 1) + " other cases",
                             "if the force of the body on the tip was measured, set force_of = \"body\"");
    for (const size_t c : against)
      findings_.warning(where(c), "the force points against the way of the tip, unlike in the other cases",
                        "correct its sign, or leave it blank");
  }

  void examine_size() {
    const std::optional<double> E = apparent_young(data_.experiment);
    if (!E) return;
    const std::string says =
        "by force, depth and radius of the tip, Young's modulus is about " + three_digits(*E) + " Pa";
    if (*E >= kSoftestPoked && *E <= kStiffestPoked)
      return findings_.note(data_.source.cases, says,
                            "if that is far from what the body feels like, check units: force and length");
    std::string remedy = "check units: force and length";
    for (const std::string& unit : unit_names("force")) {
      const double other = *E * unit_in_si("force", unit);
      if (unit != "N" && other > kSoftestPoked && other < kStiffestPoked) {
        remedy = "if forces are in " + unit + ", set units = { force = \"" + unit + "\" }: it would be " +
                 three_digits(other) + " Pa";
        if (unit == "mN" || unit == "g" || unit == "kN") break;
      }
    }
    findings_.warning(data_.source.cases, says + ", which nothing soft has", remedy);
  }

  // Kitchen scales show whole grams.
  void examine_rounding() {
    int whole = 0, count = 0;
    double largest = 0;
    for (const LoadCase& load : cases_) {
      if (!load.force) continue;
      const double along = norm(*load.force);
      largest = std::max(largest, along);
      if (along == 0) continue;
      ++count;
      bool is_whole = true;
      for (int i = 0; i < 3; ++i) is_whole &= (*load.force)[i] == std::round((*load.force)[i]);
      whole += is_whole;
    }
    if (count >= kEnough && whole == count && largest >= 20)
      findings_.warning(data_.source.cases,
                        "all " + std::to_string(count) + " forces are whole numbers, up to " + three_digits(largest) +
                            " N, as scales show grams",
                        "if they are grams, set units = { force = \"g\" }");
  }

  // Of cases whose force is more than noise.
  std::map<std::string, std::vector<size_t>> groups() const {
    std::map<std::string, std::vector<size_t>> groups;
    for (size_t c = 0; c < cases_.size(); ++c)
      if (apparent_young(cases_[c]) && norm(*cases_[c].force) > 3 * deviation_along(cases_[c]))
        groups[cases_[c].group].push_back(c);
    return groups;
  }

  // A poke that seems far stiffer or softer than the others.
  void examine_groups() {
    std::vector<double> stiffness;
    const auto by_group = groups();
    if (by_group.size() < 3) return;
    const auto of = [&](const std::vector<size_t>& members) {
      std::vector<double> E;
      for (const size_t c : members) E.push_back(*apparent_young(cases_[c]));
      return median(E);
    };
    for (const auto& [name, members] : by_group) stiffness.push_back(of(members));
    const double usual = median(stiffness);
    for (const auto& [name, members] : by_group) {
      const double ratio = of(members) / usual;
      if (ratio < kStriking && ratio > 1 / kStriking) continue;
      if (ratio < kUnlike && ratio > 1 / kUnlike) {
        findings_.warning(
            where(members.front()),
            std::string("the body seems much ") + (ratio > 1 ? "stiffer" : "softer") + " here than in the other pokes",
            "check this force; an inclusion or an edge near the tip explains it as well");
        continue;
      }
      findings_.warning(
          where(members.front()), "the body seems " + factor_text(ratio) + " as stiff here as in the other pokes",
          "correct the unit of its force" + unit_of_ratio(ratio) + " or its pose, or leave the force blank");
    }
  }

  // The same tip at the same place and depth meets the same force.
  void examine_repetitions() {
    for (size_t c = 0; c < cases_.size(); ++c)
      for (size_t first = 0; first < c; ++first) {
        if (!is_same_poke(cases_[first], cases_[c])) continue;
        const double before = norm(*cases_[first].force), now = norm(*cases_[c].force);
        const double difference = norm(*cases_[c].force - *cases_[first].force);
        const double noise = kOtherDeviations * (deviation_along(cases_[first]) + deviation_along(cases_[c]));
        if (difference > std::max(noise, kOtherForce * std::max(before, now)))
          findings_.warning(where(c),
                            "the force is " + three_digits(now) + " N, but " + three_digits(before) +
                                " N under the same load in '" + cases_[first].name + "'",
                            "correct the wrong one, or leave both blank: a fit of both finds neither stiffness");
        break;
      }
  }

  static bool is_same_poke(const LoadCase& a, const LoadCase& b) {
    if (!a.tip || !b.tip || !a.force || !b.force) return false;
    if (a.tip->shape != b.tip->shape || a.tip->contact != b.tip->contact) return false;
    const double radius = a.tip->radius, depth = load_size(a);
    return std::abs(b.tip->radius - radius) < kSamePlace * radius &&
           norm(b.touch.center - a.touch.center) < kSamePlace * radius &&
           norm((b.pose.center - b.touch.center) - (a.pose.center - a.touch.center)) < kSameDepth * depth;
  }

  static std::string unit_of_ratio(double ratio) {
    for (const char* unit : {"mN", "g", "kN", "kg"})
      for (const double r : {ratio, 1 / ratio})
        if (std::abs(std::log(r * unit_in_si("force", unit))) < std::log(2.0))
          return std::string(" (it is off as ") + unit + " are from N)";
    return "";
  }

  void examine_falling() {
    for (size_t c = 1; c < cases_.size(); ++c) {
      const LoadCase &last = cases_[c - 1], &load = cases_[c];
      if (load.group != last.group || !load.force || !last.force || !load.tip || !last.tip) continue;
      const double noise = 3 * (deviation_along(load) + deviation_along(last));
      const bool is_deeper = load_size(load) > 1.001 * load_size(last);
      if (is_deeper && norm(*load.force) < kFalling * norm(*last.force) - noise)
        findings_.warning(where(c),
                          "the force falls from " + three_digits(norm(*last.force)) + " N to " +
                              three_digits(norm(*load.force)) + " N though the tip goes deeper than in '" + last.name +
                              "'",
                          "correct its force or its pose; a body that slips or buckles is no equilibrium to fit");
    }
  }

  const DataSet& data_;
  const std::vector<LoadCase>& cases_;
  DataFindings& findings_;
};

}  // namespace

void diagnose_forces(const DataSet& data, DataFindings& findings) { ForceDiagnosis(data, findings).run(); }

}  // namespace aspic
