// Search for the directions of fibres, whose misfit has several minima: fits from a few directions that cover all axes.
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "estimate/fit.h"
#include "pipeline/fit_plan.h"

namespace aspic {

// Returns whether the plan fits directions.
bool fits_fibres(const FitPlan& plan);

// The fitted directions of a map: one for the body or one per region.
struct FibreTilts {
  int parameter[2] = {};  // of the map
  int first[2] = {};      // of their entries in p
  std::vector<int> tet;   // a tet of each region, in the order of the entries
};
FibreTilts fibre_tilts(const ParameterMap& map);

// Direction of each region at p.
std::vector<Vec3d> fibre_directions(const ParameterMap& map, std::span<const double> p);

// Makes p the guess of the plan, with its directions as reference directions.
void adopt_values(const ParameterMap& map, std::span<const double> p, FitPlan& plan);

// Largest angle between directions of the same minimum [rad]: 5 degrees. Chosen.
inline constexpr double kSameFibres = 0.087;

// Angle between two axes [rad]: 0 to pi/2; their signs are irrelevant.
double angle_between(const Vec3d& a, const Vec3d& b);

struct FibreMinimum {
  double objective = 0;           // |r|^2 / 2 plus the prior
  std::vector<Vec3d> directions;  // one per region
};

struct FibreSearch {
  std::vector<FibreMinimum> minima;  // the best one first
  std::string failure;               // of the first fit; empty: it succeeded
};

struct FibreTrial {
  FitReport report;
  std::string failure;  // empty: the fit succeeded, and its values were adopted by the plan
};
// Fits a plan. `name`: unique name of the fit. `what`: the fit for the user.
using FitFibres = std::function<FibreTrial(FitPlan& plan, const std::string& name, const std::string& what)>;

// Sets plan.fibre_directions and the guesses to those of the best minimum.
FibreSearch search_fibres(FitPlan& plan, int regions, const FitFibres& fit);

// Half the opening of the cone that contains the direction of a region with 95 % [rad], for the covariance of its
// tilts: variances of u and v, and their covariance. pi/2: undetermined.
struct TiltCovariance {
  double uu = 0, uv = 0, vv = 0;
};
double cone_of(const TiltCovariance& covariance, const Vec3d& du, const Vec3d& dv);

}  // namespace aspic
