#include "capture/test_curves.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>

#include "base/error.h"
#include "base/printable.h"
#include "io/csv_reader.h"

namespace aspic {
namespace {

constexpr double kLargestStretch = 1e3;

struct StressColumn {
  size_t index;
  double pascals;
};

// Exports of testing machines have strains or forces instead.
void require_columns(const CsvReader& csv, const std::string& file) {
  const auto has = [&](const char* word) {
    return std::any_of(csv.columns().begin(), csv.columns().end(), [&](std::string column) {
      for (char& c : column) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      return column.find(word) != std::string::npos;
    });
  };
  for (const char* column : {"test", "stretch"}) {
    if (csv.has(column)) continue;
    std::string list;
    for (const std::string& name : csv.columns()) list += (list.empty() ? "" : ", ") + name;
    std::string message = file + ":1: missing column '" + column +
                          "'; expected test, stretch, stress_kPa, but the table has " + elided(list, 200);
    if (!csv.has("test")) message += "; test is uniaxial, equibiaxial, planar or simple_shear in every row";
    if (has("strain") || has("extension") || has("displacement"))
      message += "; stretch is 1 + strain (a strain of 5 % is 1.05), or length over length at rest";
    if (has("force") || has("load")) message += "; stress is force over area at rest";
    throw InvalidInput(message);
  }
}

StressColumn stress_column(const CsvReader& csv, const std::string& file) {
  struct Unit {
    const char* column;
    double pascals;
  };
  constexpr std::array<Unit, 3> kUnits = {{{"stress_Pa", 1}, {"stress_kPa", 1e3}, {"stress_MPa", 1e6}}};
  std::vector<StressColumn> found;
  for (const Unit& unit : kUnits)
    if (csv.has(unit.column)) found.push_back({csv.column(unit.column), unit.pascals});
  if (found.size() == 1) return found.front();
  throw InvalidInput(file + ":1: has " + (found.empty() ? "no" : "more than one") +
                     " column of stresses; give the nominal stress in one column stress_Pa, stress_kPa or stress_MPa");
}

}  // namespace

std::vector<TestCurve> read_test_curves(const std::filesystem::path& path) {
  const std::string file = path.string();
  CsvReader csv(path, CsvOrigin::foreign);
  require_columns(csv, file);
  const size_t test = csv.column("test"), stretch = csv.column("stretch");
  const StressColumn stress = stress_column(csv, file);
  std::vector<TestCurve> curves;
  while (csv.next()) {
    const auto fail = [&](const std::string& what) { throw InvalidInput(csv.where() + ": " + what); };
    Deformation deformation{};
    try {
      deformation = deformation_named(csv.text(test));
    } catch (const InvalidInput& error) {
      fail(error.what());
    }
    const double l = csv.number(stretch), s = csv.number(stress.index) * stress.pascals;
    const bool is_shear = deformation == Deformation::simple_shear;
    if (!std::isfinite(l) || std::abs(l) > kLargestStretch || (!is_shear && l <= 0))
      fail("stretch = " + csv.text(stretch) + "; give length over rest length, 1 at rest");
    if (!std::isfinite(s)) fail("the stress " + csv.text(stress.index) + " is not a number; remove the row");
    const auto same = [&](const TestCurve& curve) { return curve.deformation == deformation; };
    auto curve = std::find_if(curves.begin(), curves.end(), same);
    if (curve == curves.end()) curve = curves.insert(curve, {std::string(name(deformation)), deformation, {}, {}});
    curve->stretch.push_back(l);
    curve->stress.push_back(s);
  }
  if (curves.empty()) throw InvalidInput(file + ": has no rows; give one per measured point");
  return curves;
}

}  // namespace aspic
