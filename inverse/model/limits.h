// Limits that several files share, with their sources.
#pragma once

namespace aspic {

inline constexpr double kManySigmas = 4;         // one of 16 000 normal numbers has a larger magnitude
inline constexpr double kStrongEvidence = 3;     // log of a ratio of probabilities of 20 to 1 [Kass and Raftery 1995]
inline constexpr double kTooManySquares = 2.25;  // |r|^2 per reading for errors of 1.5 standard deviations
inline constexpr double kUninformative = 100;  // standard deviation of log E without any information: a factor of e^100
inline constexpr int kFewParameters = 50;      // number up to which a dense Jacobian costs less than products with it
inline constexpr double kParameterStep = 1e-4;  // difference of p for columns of J, whose residuals have errors of 1e-9
inline constexpr double kStagnated = 1e-9;      // relative residual of linear solves that stagnate in round-off
inline constexpr int kMaxHalvings = 6;          // of a load step without an equilibrium
inline constexpr double kSameTime = 1e-6;       // fraction of a time step by which equal times may differ
inline constexpr double kMaxTimeSteps = 1e6;    // of a motion
inline constexpr double kExactSigma = 1e-4;     // standard deviation of exact readings over the largest one

}  // namespace aspic
