// Systematic errors of an experiment: which ones there are, and the experiment without them.
#pragma once
#include <array>
#include <span>
#include <string>
#include <vector>

#include "model/misfit.h"

namespace aspic {

inline constexpr int kErrorKinds = 9;
using ErrorSigmas = std::array<double, kErrorKinds>;  // standard deviation of each ErrorKind; 0: no such error

// Errors that change the load or a reading of some case. Layers, friction and rims have the standard deviations of
// the cases.
std::vector<SystematicError> systematic_errors(const std::vector<LoadCase>& cases, const ErrorSigmas& sigmas);

bool concerns(const SystematicError& error, const LoadCase& load);
// Whether the error belongs to a group of cases, so that no other group contains information about it.
bool is_of_group(const SystematicError& error);
std::string name_of(const SystematicError& error);  // "position x of 'poke 1'"
std::string unit_of(const SystematicError& error);  // empty: dimensionless

// Actual loads, and readings without the given errors, from those measured (errors of value 0).
Corrected without_errors(OnMesh measured, std::span<const double> values);

// Readings that instruments with the errors of the experiment show of a prediction for the case.
CasePrediction as_read(const Corrected& experiment, const LoadCase& load, CasePrediction prediction);

// Offset of the force of a case, before scaling [N].
Vec3d tare_of(const std::vector<SystematicError>& errors, const LoadCase& load);
// Velocity of the center and angular velocity of the indenter or grip per unit of an error of its pose.
struct Twist {
  Vec3d center{}, rotation{};
};
Twist twist_of(const SystematicError& error, const LoadCase& load);

}  // namespace aspic
