// A function written in Python as an objective.
#pragma once
#include <memory>

#include "function.h"
#include "linalg/block_sparse.h"

namespace aspic::python {

// Calls f.value(x), f.gradient(x) and f.hessian(x), which returns a dense or a scipy matrix for x.ravel(). Arrays have
// the shape of the initial x.
class PythonObjective : public Objective {
 public:
  PythonObjective(py::object f, Layout layout, Callbacks& callbacks);
  ~PythonObjective() override;

  Evaluation evaluate(std::span<const double> x) override;
  void gradient(std::span<const double> x, std::span<double> g) override;
  const BlockSparse& evaluate_hessian(std::span<const double> x, const Projection& projection) override;
  ObjectiveScales scales() const override { return {.gradient_round_off = round_off_}; }

 private:
  void assemble(const py::object& matrix, const Projection& projection);

  py::object f_;
  Layout layout_;
  Callbacks& callbacks_;
  BlockPattern pattern_;
  std::unique_ptr<BlockSparse> H_;
  double round_off_ = 0;
};

class PythonFunction : public Function {
 public:
  // x: any point, which gives the shape of arrays.
  static std::shared_ptr<PythonFunction> make(const py::object& f, const py::object& x);

 private:
  PythonFunction(std::unique_ptr<PythonObjective> E, const Layout& layout, std::shared_ptr<Callbacks> callbacks)
      : Function(E.get(), layout, std::move(callbacks)), E_(std::move(E)) {}
  std::unique_ptr<PythonObjective> E_;
};

}  // namespace aspic::python
