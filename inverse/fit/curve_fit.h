// Fits a material to measured curves of homogeneous deformation, several at once, by least squares.
#pragma once
#include <string>
#include <vector>

#include "fit/bounded_least_squares.h"
#include "fit/homogeneous.h"

namespace aspic {

struct TestCurve {
  std::string name;  // "equibiaxial"
  Deformation deformation = Deformation::uniaxial;
  std::vector<double> stretch;  // stretch, or amount of shear [1]
  std::vector<double> stress;   // nominal stress [Pa]
};

// Equal weights for: every unit of stress (absolute), every curve (its mean square), or every relative error (of each
// point, with a floor of 5 % of the largest stress of its curve).
enum class Weighting { absolute, balanced, relative };

struct CurveFitOptions {
  std::string material = "neo_hookean";
  Volume volume = Volume::incompressible;
  double poisson = 0.49;  // for compressible bodies, and for the scene of the material
  Weighting weighting = Weighting::balanced;
  std::vector<std::string> held;  // material parameters that keep their default
  int starts = 6;                 // number of initial guesses: the defaults, and random ones (fixed seed)
};

struct FittedParameter {
  std::string name, unit;  // "young", and parameters of the material
  double value = 0;
  double sigma = 0;  // standard deviation from the scatter of the residuals; infinite: undetermined
  bool at_bound = false, is_held = false;
};

struct CurveErrors {
  std::string name;
  std::vector<double> predicted;  // [Pa]
  double rms = 0;                 // root mean square of predicted - measured [Pa]
  double relative = 0;            // |predicted - measured| / |measured|, norms over the points
  double largest = 0;             // largest |predicted - measured| over the largest |measured|
  double r_squared = 0;           // 1 - sum of squares / sum of squares about the mean of the measurements
};

struct CurveFit {
  std::string material;
  MaterialParameters parameters;
  double poisson = 0;
  std::vector<FittedParameter> fitted;
  std::vector<CurveErrors> curves;
  double relative = 0, r_squared = 0;  // over the points of all curves
  bool is_converged = false;
  int iterations = 0;
  std::vector<double> starts;  // |r|^2 / 2 from each initial guess; infinite: failed
};

// Residuals as a function of ln mu and the material's other free parameters (as logarithms if their range spans powers
// of ten). Stores a reference to the curves.
class CurveMisfit : public LeastSquares {
 public:
  CurveMisfit(const std::vector<TestCurve>& curves, const CurveFitOptions& options);  // throws InvalidInput

  int parameter_count() const override { return static_cast<int>(bounds_.size()); }
  int residual_count() const override { return static_cast<int>(scale_.size()); }
  bool evaluate(std::span<const double> p, std::span<double> r) override;
  bool linearize() override { return true; }
  void multiply(std::span<const double> dp, std::span<double> dr) override;
  void multiply_transposed(std::span<const double> w, std::span<double> pbar) override;

  const std::vector<Bounds>& bounds() const { return bounds_; }
  std::vector<double> guess(int start) const;
  MaterialParameters parameters(std::span<const double> p) const;
  std::vector<FittedParameter> described(const BoundedFit& fit) const;
  const std::vector<double>& predicted() const { return predicted_; }  // from the last evaluate(), curve by curve

 private:
  struct Own {  // a fitted parameter of the material
    int index = 0;
    bool is_log = false;
  };
  void set_scale();
  double fitted_shear() const;  // initial guess of mu

  const std::vector<TestCurve>& curves_;
  CurveFitOptions options_;
  const MaterialInfo& info_;
  std::vector<Own> own_;
  std::vector<Bounds> bounds_;
  std::vector<double> scale_, predicted_, jacobian_;  // per point [Pa]; jacobian_ is row-major
};

// Throws InvalidInput for an unknown material, a curve without points, or invalid numbers.
CurveFit fit_curves(const std::vector<TestCurve>& curves, const CurveFitOptions& options);

// material = { model = "fung", young = 3.1e5, poisson = 0.49, b = 0.2 }
std::string scene_line(const CurveFit& fit);

}  // namespace aspic
