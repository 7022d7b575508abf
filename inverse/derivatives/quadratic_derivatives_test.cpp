// Derivatives of quadratic tets with respect to the parameters, with a mean volume and with the barrier at nodes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "derivatives/parameter_derivatives.h"
#include "energy/quadratic_boxes_test.h"
#include "math/vectors.h"

namespace aspic {
namespace {

void expect_parameter_derivatives(ParametersOf parameters_of, const std::vector<std::string>& names, const Mat3d& A) {
  for (const std::string& material : names) {
    const MaterialInfo& info = material_info(material);
    std::vector<MaterialParameters> parameters = parameters_of(small(), info);
    const auto V = make_tet_elasticity(material, small(), 0, parameters);
    const std::vector<double> x = positions(small(), A, 0.02 * determinant(A));
    const int count = V->parameter_count();
    std::vector<double> change(parameters.size() * count), force(x.size(), 0.0), gradient(change.size(), 0.0);
    for (size_t i = 0; i < change.size(); ++i) change[i] = std::sin(1.0 + static_cast<double>(i));
    derivatives_of(*V)->add_force(x, change, 1, force);
    std::vector<double> difference(x.size(), 0.0);
    constexpr double kStep = 1e-5;
    for (const double sign : {1.0, -1.0}) {
      std::vector<MaterialParameters> other = parameters;
      for (size_t t = 0; t < other.size(); ++t) {
        other[t].lame.mu += sign * kStep * change[count * t];
        other[t].lame.lambda += sign * kStep * change[count * t + 1];
        for (int k = 2; k < count; ++k) other[t].extra[k - 2] += sign * kStep * change[count * t + k];
      }
      V->set_parameters(other);
      V->add_gradient(x, sign / (2 * kStep), difference);
    }
    V->set_parameters(parameters);
    double error = 0;
    for (size_t i = 0; i < x.size(); ++i) error = std::max(error, std::abs(force[i] - difference[i]));
    EXPECT_LT(error, 1e-7 * max_abs(force)) << material;
    derivatives_of(*V)->add_gradient(x, x, 1, gradient);
    EXPECT_NEAR(dot(gradient, change), dot(force, x), 1e-12 * std::abs(dot(force, x))) << material;
  }
}

TEST(QuadraticElasticity, ParameterDerivativesMatchDifferences) {
  for (const ParametersOf parameters_of : kBothParameters) {
    expect_parameter_derivatives(parameters_of, {"neo_hookean", "fung"}, kAffine);
    expect_parameter_derivatives(parameters_of, {kBarrier}, kFlat);
  }
}

void expect_hessian_derivatives(ParametersOf parameters_of, Definiteness definiteness, const std::string& material,
                                const Mat3d& A) {
  std::vector<MaterialParameters> parameters = parameters_of(small(), material_info(material));
  const auto V = make_tet_elasticity(material, small(), 0, parameters);
  const BlockPattern pattern = bound_pattern(small(), *V);
  const std::vector<double> x = positions(small(), A, 0.02 * determinant(A)), u = positions(small(), A, 0.5);
  const auto direction = [](size_t i) { return std::sin(1.0 + static_cast<double>(i)); };
  std::vector<double> by_x(x.size(), 0.0), by_parameters(2 * parameters.size(), 0.0), Hu(x.size());
  derivatives_of(*V)->add_hessian_derivatives(x, u, u, definiteness, {1, by_x, by_parameters});
  const auto energy = [&](double x_step, double parameter_step) {
    std::vector<double> moved = x;
    for (size_t i = 0; i < x.size(); ++i) moved[i] += x_step * direction(i);
    std::vector<MaterialParameters> other = parameters;
    for (size_t t = 0; t < other.size(); ++t) {
      other[t].lame.mu += parameter_step * direction(2 * t);
      other[t].lame.lambda += parameter_step * direction(2 * t + 1);
    }
    V->set_parameters(other);
    BlockSparse H(pattern);
    V->add_hessian(moved, 1, {definiteness}, H);
    H.multiply(u, Hu);
    return dot(u, Hu);
  };
  double along_x = 0, along_parameters = 0;
  for (size_t i = 0; i < x.size(); ++i) along_x += by_x[i] * direction(i);
  for (size_t i = 0; i < by_parameters.size(); ++i) along_parameters += by_parameters[i] * direction(i);
  const double h = 1e-5 * determinant(A);
  EXPECT_NEAR((energy(h, 0) - energy(-h, 0)) / (2 * h), along_x, 2e-6 * std::abs(along_x));
  EXPECT_NEAR((energy(0, 1e-5) - energy(0, -1e-5)) / 2e-5, along_parameters, 2e-7 * std::abs(along_parameters));
}

TEST(QuadraticElasticity, HessianDerivativesMatchDifferences) {
  for (const ParametersOf parameters_of : kBothParameters) {
    for (const Definiteness definiteness : {Definiteness::exact, Definiteness::clamped}) {
      expect_hessian_derivatives(parameters_of, definiteness, "neo_hookean", kAffine);
      expect_hessian_derivatives(parameters_of, definiteness, kBarrier, kFlat);
    }
  }
}

// A fit with an initial guess below the threshold of the mean volume ends with the derivatives of its result.
TEST(MeanVolume, DerivativesDependOnCurrentPoissonsRatioAlone) {
  const std::vector<double> x = positions(small(), kAffine, 0.02);
  const auto parameters = [](double poisson) {
    return std::vector<MaterialParameters>(small().tets.size(), {lame_from_young_poisson(1e5, poisson), {}});
  };
  for (const double final_poisson : {0.2, 0.45}) {
    const auto expected = make_tet_elasticity("neo_hookean", small(), 0, parameters(final_poisson));
    const auto changed = make_tet_elasticity("neo_hookean", small(), 0, parameters(0.65 - final_poisson));
    const auto derivatives = derivatives_of(*changed);
    changed->set_parameters(parameters(final_poisson));
    const std::vector<double> change(static_cast<size_t>(changed->parameter_count() * small().tet_count()), 1.0);
    std::vector<double> rate(x.size(), 0.0), expected_rate(x.size(), 0.0);
    derivatives->add_force(x, change, 1, rate);
    derivatives_of(*expected)->add_force(x, change, 1, expected_rate);
    for (size_t i = 0; i < x.size(); ++i) EXPECT_NEAR(rate[i], expected_rate[i], 1e-12 * max_abs(expected_rate));
  }
}

}  // namespace
}  // namespace aspic
