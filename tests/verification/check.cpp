#include "verification/check.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <utility>

namespace aspic::verify {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

}  // namespace

std::string Subject::replacement(const std::string& name) const {
  const auto found = instead.find(name);
  return found == instead.end() ? name : found->second;
}

bool Row::passes() const { return std::isfinite(tolerance) && std::abs(measured - reference) <= tolerance; }

bool Findings::passes() const {
  return !rows.empty() && std::all_of(rows.begin(), rows.end(), [](const Row& row) { return row.passes(); });
}

void Findings::expect(std::string quantity, const Comparison& numbers, std::string reason, std::string unit) {
  const auto [measured, reference, tolerance] = numbers;
  rows.push_back({std::move(quantity), measured, reference, tolerance, std::move(unit), std::move(reason)});
}

void Findings::expect_small(std::string quantity, double measured, double bound, std::string reason, std::string unit) {
  expect(std::move(quantity), {measured, 0, bound}, std::move(reason), std::move(unit));
}

Findings run_check(const Check& check, const Subject& subject) {
  Findings findings;
  std::string trouble;
  try {
    check.run(subject, findings);
    if (findings.rows.empty()) trouble = "the check found nothing";
  } catch (const std::exception& error) {
    trouble = error.what();
  }
  if (!trouble.empty()) findings.expect("could not be computed", {kNan, kNan, 0}, trouble);
  return findings;
}

}  // namespace aspic::verify
