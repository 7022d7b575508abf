// Measured curves of homogeneous deformation as a table: columns `test` (uniaxial, equibiaxial, planar, simple_shear),
// `stretch` (or amount of shear) and the nominal stress as `stress_Pa`, `stress_kPa` or `stress_MPa`. Further columns
// are left alone. Rows of one test need not stand together.
#pragma once
#include <filesystem>
#include <vector>

#include "fit/curve_fit.h"

namespace aspic {

// One curve per test, in the order of their first rows. Throws InvalidInput with file, line, value and remedy.
std::vector<TestCurve> read_test_curves(const std::filesystem::path& path);

}  // namespace aspic
