// Systematic errors that capture.toml states.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "data/settings.h"
#include "model/systematic_errors.h"

namespace aspic {

// Largest coefficient of friction of a tip, chosen. Measured ones are below 1 on tissue and skin, and reach 3 on dry
// silicone.
inline constexpr double kLargestFriction = 5;

// Throws InvalidInput for errors that concern no case.
std::vector<SystematicError> read_systematic_errors(const CaptureSettings& settings,
                                                    const std::vector<LoadCase>& cases);
// Standard deviations of logarithms.
struct TipSigmas {
  std::optional<double> layer;  // of the stiffness of the layer; empty: unknown
  double friction = 0;          // of the coefficient
  double rim = 0;               // of the rim of a sliding disc
};
// Standard deviation of the logarithm of a rim that is not stated, about log(5) / 2: with 95 %, it is within a factor
// of 5, as far as its limits.
inline constexpr double kRimSigma = 0.8;

// Radius of the rim of a tip [m]; 0 for spheres and bonded tips.
double read_rim(const CaptureSettings& settings, const Value& tip);

// Throws InvalidInput for inconsistent keys of a [[tip]].
TipSigmas read_tip_sigmas(const CaptureSettings& settings, const Value& tip);

// The keys of `errors` for these errors, as an inline table in SI units.
std::string errors_text(const std::vector<SystematicError>& errors);

}  // namespace aspic
