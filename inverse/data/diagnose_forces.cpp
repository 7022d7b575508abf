#include <algorithm>
#include <cmath>
#include <map>

#include "data/apparent_stiffness.h"
#include "data/case_table.h"
#include "data/data_findings.h"
#include "data/units.h"
#include "math/vectors.h"
#include "model/limits.h"

namespace aspic {
namespace {

// Limits of findings are chosen: they decide about messages and refusals, not about results.
constexpr double kMinTypicalYoung = 50, kLargestTypicalYoung = 1.5e7;  // typical Young's moduli of soft bodies [Pa]
constexpr double kStriking = 2.5;    // suspicious ratio: a wrong force, or an inclusion
constexpr double kSamePlace = 0.1;   // tolerance of equal places of an indenter, relative to its radius
constexpr double kOtherForce = 0.2;  // relative difference of forces that contradict
constexpr double kLargest = 1e9, kFinestForce = 1e-12;  // largest plausible force, and finest sigma [N]
constexpr int kEnough = 6;  // forces with a decimal that are whole by chance once in a million

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
    bool has_force = false, has_other = data_.experiment.scan_gravity.has_value();
    for (size_t c = 0; c < cases_.size(); ++c) {
      const LoadCase& load = cases_[c];
      has_force |= load.force.has_value() || load.torque.has_value();
      has_other |= load.pressure != 0 || norm(load.gravity) > 0;
      if (load.indenter && !load.force && !load.torque) without.push_back(c);
    }
    if (!has_force && !has_other)
      return findings_.warning(data_.source.cases,
                               "there is no force: only ratios of stiffness can be determined, not the level of the "
                               "stiffness",
                               "measure at least one force, or a case under gravity or pressure");
    if (!without.empty() && has_force)
      findings_.note(where(without.front()),
                     "is one of " + std::to_string(without.size()) + " pokes without a force (of " +
                         std::to_string(cases_.size()) + " cases)",
                     "its motion is still fitted");
  }

  bool examine_readings() {
    size_t zero = 0, measured = 0;
    for (size_t c = 0; c < cases_.size(); ++c) {
      const LoadCase& load = cases_[c];
      if (!load.force) continue;
      const Vec3d& sd = load.force_sigma;
      if (!(norm(*load.force) < kLargest))
        return refuse(where(c), "the force is larger than " + three_digits(kLargest) + " N",
                      "correct it, or leave it blank");
      if (std::min({sd[0], sd[1], sd[2]}) < kFinestForce)
        return refuse(where(c),
                      "the force has a standard deviation of " + three_digits(std::min({sd[0], sd[1], sd[2]})) +
                          " N, which no gauge attains",
                      "check the unit of force_sd; leave it blank for 1 % of the largest force");
      if (!load.indenter || load_size(load) == 0) continue;
      ++measured;
      zero += norm(*load.force) == 0;
    }
    if (zero > 0 && zero == measured)
      findings_.error(data_.source.cases, "all forces are 0, although the indenter enters the body",
                      "leave them blank if they were not measured");
    return true;
  }

  bool refuse(const std::string& where, const std::string& what, const std::string& remedy) {
    findings_.error(where, what, remedy);
    return false;
  }

  static std::string device(const LoadCase& load) { return load.grip ? "grip" : "indenter"; }

  // Motion that the force must not oppose; 0: there is none. A grip also carries the weight of the body.
  static Vec3d way_of(const LoadCase& load) {
    if (load.indenter) return load.pose.center - load.touch.center;
    return load.grip && load.pressure == 0 && norm(load.gravity) == 0 ? load.grip->displacement : Vec3d{};
  }

  // The force must act along the motion of the indenter or of the grip.
  void examine_signs() {
    std::vector<size_t> against;
    int measured = 0;
    for (size_t c = 0; c < cases_.size(); ++c) {
      if (!cases_[c].force) continue;
      const Vec3d way = way_of(cases_[c]);
      if (norm(way) == 0) continue;
      const double along = dot(way, *cases_[c].force);
      ++measured;
      const double noise = 3 * sigma_along(cases_[c]);
      if (along < -norm(way) * std::max(0.1 * norm(*cases_[c].force), noise)) against.push_back(c);
    }
    if (against.empty()) return;
    if (2 * static_cast<int>(against.size()) > measured)
      return findings_.error(where(against.front()),
                             "the force opposes the motion of the " + device(cases_[against.front()]) +
                                 ", here and in " + std::to_string(against.size() - 1) + " other cases",
                             "if the force of the body on the tip was measured, set force_of = \"body\"");
    for (const size_t c : against)
      findings_.warning(where(c),
                        "the force opposes the motion of the " + device(cases_[c]) + ", unlike in the other cases",
                        "correct its sign, or leave it blank");
  }

  void examine_size() {
    const std::optional<double> E = apparent_young(data_.experiment);
    if (!E) return;
    const std::string finding =
        "force, depth and radius of the indenter imply a Young's modulus of about " + three_digits(*E) + " Pa";
    if (*E >= kMinTypicalYoung && *E <= kLargestTypicalYoung)
      return findings_.note(data_.source.cases, finding,
                            "if this is implausible for the body, check units: force and length");
    std::string remedy = "check units: force and length";
    for (const std::string& unit : unit_names("force")) {
      const double other = *E * unit_in_si("force", unit);
      if (unit != "N" && other > kMinTypicalYoung && other < kLargestTypicalYoung) {
        remedy = "if forces are in " + unit + ", set units = { force = \"" + unit + "\" }: it would be " +
                 three_digits(other) + " Pa";
        if (unit == "mN" || unit == "g" || unit == "kN") break;
      }
    }
    findings_.warning(data_.source.cases, finding + ", too large for soft bodies", remedy);
  }

  // Kitchen scales show integral grams.
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
                            " N, as from scales in grams",
                        "if they are grams, set units = { force = \"g\" }");
  }

  // Groups the cases whose force exceeds the noise.
  std::map<std::string, std::vector<size_t>> groups() const {
    std::map<std::string, std::vector<size_t>> groups;
    for (size_t c = 0; c < cases_.size(); ++c)
      if (apparent_young(cases_[c]) && norm(*cases_[c].force) > 3 * sigma_along(cases_[c]))
        groups[cases_[c].group].push_back(c);
    return groups;
  }

  // Finds indentations with implausibly high or low stiffness.
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
    const double typical = median(stiffness);
    for (const auto& [name, members] : by_group) {
      const double ratio = of(members) / typical;
      if (ratio < kStriking && ratio > 1 / kStriking) continue;
      if (ratio < kUnlike && ratio > 1 / kUnlike) {
        findings_.warning(
            where(members.front()),
            std::string("the body seems much ") + (ratio > 1 ? "stiffer" : "softer") + " here than in the other pokes",
            "check this force; an inclusion or an edge near the indenter is also possible");
        continue;
      }
      findings_.warning(
          where(members.front()), "the body seems " + factor_text(ratio) + " as stiff here as in the other pokes",
          "correct the unit of its force" + unit_of_ratio(ratio) + " or its pose, or leave the force blank");
    }
  }

  // Compares forces of the same indenter at the same place and depth.
  void examine_repetitions() {
    for (size_t c = 0; c < cases_.size(); ++c)
      for (size_t first = 0; first < c; ++first) {
        if (!is_same_indentation(cases_[first], cases_[c])) continue;
        const double before = norm(*cases_[first].force), now = norm(*cases_[c].force);
        const double difference = norm(*cases_[c].force - *cases_[first].force);
        const double noise = kManySigmas * (sigma_along(cases_[first]) + sigma_along(cases_[c]));
        if (difference > std::max(noise, kOtherForce * std::max(before, now)))
          findings_.warning(where(c),
                            "the force is " + three_digits(now) + " N, but " + three_digits(before) +
                                " N under the same load in '" + cases_[first].name + "'",
                            "correct the wrong one, or leave both blank: a fit of both is wrong for each");
        break;
      }
  }

  static bool is_same_indentation(const LoadCase& a, const LoadCase& b) {
    if (!a.indenter || !b.indenter || !a.force || !b.force) return false;
    if (a.indenter->shape != b.indenter->shape || a.indenter->contact != b.indenter->contact) return false;
    const double radius = a.indenter->radius, depth = load_size(a);
    return std::abs(b.indenter->radius - radius) < kSamePlace * radius &&
           norm(b.touch.center - a.touch.center) < kSamePlace * radius &&
           norm((b.pose.center - b.touch.center) - (a.pose.center - a.touch.center)) < kNegligible * depth;
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
      if (load.group != last.group || !load.force || !last.force || !load.indenter || !last.indenter) continue;
      const double noise = 3 * (sigma_along(load) + sigma_along(last));
      const bool is_deeper = load_size(load) > 1.001 * load_size(last);
      if (is_deeper && norm(*load.force) < (1 - kOtherForce) * norm(*last.force) - noise)
        findings_.warning(where(c),
                          "the force falls from " + three_digits(norm(*last.force)) + " N to " +
                              three_digits(norm(*load.force)) + " N although the indenter is deeper than in '" +
                              last.name + "'",
                          "correct its force or its pose; a slipping or buckling body cannot be fitted");
    }
  }

  const DataSet& data_;
  const std::vector<LoadCase>& cases_;
  DataFindings& findings_;
};

}  // namespace

void diagnose_forces(const DataSet& data, DataFindings& findings) { ForceDiagnosis(data, findings).run(); }

}  // namespace aspic
