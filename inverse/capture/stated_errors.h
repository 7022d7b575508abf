// Systematic errors that capture.toml states.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "capture/settings.h"
#include "fit/systematic_errors.h"

namespace aspic {

// Throws InvalidInput for errors that concern no case.
std::vector<SystematicError> read_systematic_errors(const CaptureSettings& settings,
                                                    const std::vector<LoadCase>& cases);
// Standard deviation of the logarithm of the stiffness of a [[tip]]; empty: unknown.
std::optional<double> read_layer_sigma(const Value& tip);

// The keys of `errors` for these errors, as an inline table in SI units.
std::string errors_text(const std::vector<SystematicError>& errors);

}  // namespace aspic
