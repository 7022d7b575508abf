#include "aspic/verify_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "aspic/progress.h"

namespace aspic::cli {

void print_list(const std::vector<const verify::Check*>& checks) {
  for (const verify::Check* check : checks) fmt::print("{:<34} {}\n", check->key(), check->title);
}

void print_head(const verify::Check& check, size_t number, size_t count) {
  fmt::print("\n[{}/{}] {}: {}\n", number, count, check.key(), check.title);
  std::fflush(stdout);
}

std::string value_text(double value, const verify::Row& row) {
  if (!std::isfinite(value)) return fmt::format("{}", value);
  if (row.reference == 0 || !(row.tolerance > 0)) return fmt::format("{:.3g}", value);
  const double digits = std::log10(std::abs(row.reference) / row.tolerance);
  return fmt::format("{:#.{}g}", value, std::clamp(static_cast<int>(std::ceil(digits)) + 2, 3, 15));
}

std::string tolerance_text(const verify::Row& row) {
  return fmt::format("{} {:.2g}{}{}", "+-", row.tolerance, row.unit.empty() ? "" : " ", row.unit);
}

// Prints the reason above the rows that share it.
void print_rows(const Verification& result) {
  size_t width = 0;
  for (const verify::Row& row : result.findings.rows) width = std::max(width, row.quantity.size());
  std::string reason;
  for (const verify::Row& row : result.findings.rows) {
    if (row.reason != reason) fmt::print("      ({})\n", row.reason);
    reason = row.reason;
    fmt::print("{}  {:<{}}  {:>14}  {:>14}  {}\n", row.passes() ? "pass" : "FAIL", row.quantity, width,
               value_text(row.measured, row), value_text(row.reference, row), tolerance_text(row));
  }
  fmt::print("      {:.1f} s\n", result.seconds);
  std::fflush(stdout);
}

std::string how_text(const verify::Subject& subject, bool all, double seconds) {
  std::string text = all ? "All checks" : "Selected checks";
  text += subject.quick ? ", the coarse cases (--quick)" : "";
  for (const auto& [name, other] : subject.instead) text += fmt::format(", {} in place of {}", other, name);
  return text + fmt::format(", in {}.", duration_text(seconds));
}

std::string count_text(const std::vector<Verification>& results) {
  size_t rows = 0, failed = 0;
  for (const Verification& result : results) {
    rows += result.findings.rows.size();
    for (const verify::Row& row : result.findings.rows) failed += row.passes() ? 0 : 1;
  }
  return fmt::format("{} check{}, {} rows: {}", results.size(), results.size() == 1 ? "" : "s", rows,
                     failed == 0 ? "all pass" : fmt::format("{} FAIL", failed));
}

}  // namespace aspic::cli
