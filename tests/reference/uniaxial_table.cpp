#include "reference/uniaxial.h"

namespace aspic::verify {

const std::vector<UniaxialReference>& uniaxial_table() {
  static const std::vector<UniaxialReference> table = {
      {"neo_hookean_log", 0.3, 0.5, {1.21076739, -0.93535206}},
      {"neo_hookean_log", 0.3, 1.5, {0.88017459, 0.37828018}},
      {"neo_hookean_log", 0.3, 2.0, {0.79807754, 0.64674466}},
      {"neo_hookean", 0.3, 0.5, {1.09544512, -0.73076923}},
      {"neo_hookean", 0.3, 1.5, {0.86922699, 0.38319088}},
      {"neo_hookean", 0.3, 2.0, {0.77459667, 0.65384615}},
      {"stable_neo_hookean", 0.3, 0.5, {1.09464699, -0.70585424}},
      {"stable_neo_hookean", 0.3, 1.5, {0.86708612, 0.40444552}},
      {"stable_neo_hookean", 0.3, 2.0, {0.77104534, 0.73211342}},
      {"corotated", 0.3, 0.5, {1.14713687, -0.64428635}},
      {"corotated", 0.3, 1.5, {0.86933210, 0.44286862}},
      {"corotated", 0.3, 2.0, {0.77317017, 0.83668387}},
      {"stvk", 0.3, 0.5, {1.10679718, -0.18750000}},
      {"stvk", 0.3, 1.5, {0.79056942, 0.93750000}},
      {"stvk", 0.3, 2.0, {0.31622777, 3.00000000}},
      {"neo_hookean", 0.45, 0.5, {1.34164079, -1.06896552}},
      {"neo_hookean", 0.45, 1.5, {0.82999331, 0.35887612}},
      {"neo_hookean", 0.45, 2.0, {0.72456884, 0.59913793}},
      {"stable_neo_hookean", 0.45, 0.5, {1.33193685, -1.10935098}},
      {"stable_neo_hookean", 0.45, 1.5, {0.82899404, 0.37542793}},
      {"stable_neo_hookean", 0.45, 2.0, {0.72288084, 0.66717118}},
  };
  return table;
}

}  // namespace aspic::verify
