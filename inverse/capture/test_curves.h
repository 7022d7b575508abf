// Measured curves of homogeneous deformation as a table with columns `test` (uniaxial, equibiaxial, planar,
// simple_shear), `stretch` (or amount of shear) and the nominal stress as `stress_Pa`, `stress_kPa` or `stress_MPa`.
// Ignores other columns. Rows of a test need not be consecutive.
#pragma once
#include <filesystem>
#include <vector>

#include "fit/curve_fit.h"

namespace aspic {

// Returns one curve per test in order of first appearance. Throws InvalidInput with file, line, value and remedy.
std::vector<TestCurve> read_test_curves(const std::filesystem::path& path);

}  // namespace aspic
