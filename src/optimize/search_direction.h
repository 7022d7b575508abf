// Where to go next: d = -g, or H d = -g.
#pragma once
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "linalg/linear_solver.h"
#include "optimize/objective.h"

namespace aspic {

struct DirectionReport {
  int hessians = 0, factorizations = 0, linear_iterations = 0;
  bool projected = false;  // the exact Hessian was indefinite, so a projected one was used
};

class SearchDirection {
 public:
  virtual ~SearchDirection() = default;
  virtual std::string_view name() const = 0;
  virtual std::string description() const { return std::string(name()); }  // with what it decided, and why
  // Writes d; false when no descent direction could be found. An inner solve to the relative residual
  // `forcing` is enough.
  virtual bool compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing,
                       std::span<double> d, DirectionReport& report) = 0;
};

class GradientDescent : public SearchDirection {
 public:
  std::string_view name() const override { return "gradient_descent"; }
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing, std::span<double> d,
               DirectionReport& report) override;
};

// on_demand: exact first; clamped only when the exact Hessian turns out indefinite.
enum class NewtonDefiniteness { exact, clamped, absolute, on_demand };

class Newton : public SearchDirection {
 public:
  explicit Newton(std::unique_ptr<LinearSolver> solver,
                  NewtonDefiniteness definiteness = NewtonDefiniteness::on_demand);
  std::string_view name() const override { return "newton"; }
  std::string description() const override;
  bool compute(Objective& E, std::span<const double> x, std::span<const double> g, double forcing, std::span<double> d,
               DirectionReport& report) override;
  const LinearSolver& solver() const { return *solver_; }

 private:
  bool solve(const BlockSparse& H, std::span<const double> g, double tolerance, std::span<double> d,
             DirectionReport& report);
  std::unique_ptr<LinearSolver> solver_;
  NewtonDefiniteness definiteness_;
  uint64_t analyzed_version_ = 0;
};

}  // namespace aspic
