// Limits that several files share, with their sources. "Chosen", here and elsewhere: a convention without a derivation;
// tests/bench/results/fitting.md has the effects of half and double on fits.
#pragma once
#include <cstddef>

namespace aspic {

// Decisions about errors and evidence.
inline constexpr double kManySigmas = 4;      // one of 16 000 normal numbers has a larger magnitude
inline constexpr double kStrongEvidence = 3;  // log of a ratio of probabilities of 20 to 1 [Kass and Raftery 1995]
inline constexpr double kClearRatio = 1.5;    // of two values or root mean square errors that differ clearly. Chosen
inline constexpr double kNoiseRatio = 1.1;    // of two root mean square errors that differ by noise. Chosen
inline constexpr double kTooManySquares = kClearRatio * kClearRatio;  // |r|^2 per reading
inline constexpr double kNegligible = 0.05;  // relative difference without consequences, and error in a verdict. Chosen
inline constexpr double kSettled = 0.02;     // change of log E per pass; errors of meshes change as much. Chosen
inline constexpr double kLinearRange = 1;  // change of a logarithm [1] or direction [rad] up to which a model is linear
inline constexpr double kSame = 1e-6;      // relative difference of equal values; of times, relative to a step. Chosen
inline constexpr double kFinest = 1e-9;    // relative accuracy that no measurement has. Chosen
inline constexpr double kExactError = 1e-4;  // error of exact readings over the largest one. Chosen
inline constexpr double kTooFar = 10;        // lengths, relative to the size of a body, that are mistakes. Chosen
inline constexpr size_t kMaxListed = 10;     // errors, findings or notes of one kind; others are counted. Chosen

// Priors.
inline constexpr double kUninformative = 100;  // standard deviation of log E without any information: a factor of e^100
inline constexpr double kWeakPrior = 3;        // the same of a nuisance parameter or a tilt: a factor of 20
inline constexpr double kPriorSigma = 2;       // the same of a parameter: a factor of 7

// Arithmetic and effort.
inline constexpr double kParameterStep = 1e-4;  // difference of p for columns of J, whose residuals have errors of 1e-9
inline constexpr double kCentralStep = 1e-3;    // the same for central differences: the cube root of 1e-9
inline constexpr double kStagnated = 1e-9;      // relative residual of linear solves that stagnate in round-off
inline constexpr int kFewParameters = 50;       // number up to which a dense Jacobian costs less than products with it
inline constexpr int kMaxPhases = 8;            // values of a body with one value per region. Chosen
inline constexpr int kFixedPointPasses = 8;     // docs/fitting.md states it (mesh_not_settled). Chosen
inline constexpr int kMaxHalvings = 6;          // of a load step without an equilibrium: to 1/64. Chosen
inline constexpr double kMaxTimeSteps = 1e6;    // of a motion. Chosen

}  // namespace aspic
