#include "capture/test_curves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/error.h"
#include "io/csv_reader.h"

namespace aspic {
namespace {

constexpr double kLargestStretch = 1e3;

struct StressColumn {
  size_t index;
  double pascals;
};

// Machines export forces and strains; their tables need other columns.
void require_columns(const CsvReader& csv, const std::string& file) {
  for (const char* column : {"test", "stretch"})
    if (!csv.has(column))
      throw InvalidInput(
          file + ":1: missing column '" + column +
          "'; expected test, stretch, and stress_Pa, stress_kPa or stress_MPa; found " + csv.column_list() +
          " (from a testing machine: stretch = 1 + strain, or 1 + strain / 100 of percent; stress = force / "
          "area at rest; test = uniaxial, equibiaxial, planar or simple_shear)");
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
