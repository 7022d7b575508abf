#include "python_function.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "eigenvalues.h"
#include "math/vectors.h"

namespace aspic::python {
namespace {

constexpr py::ssize_t kMaxModified = 600;  // rows of a matrix whose eigenvalues are modified

Layout layout_of(const py::object& x) {
  const py::array array = py::array::ensure(x);
  if (!array) throw py::error_already_set();
  return Layout{shape_of(reals(array, "x", shape_of(array)))};
}

}  // namespace

PythonObjective::PythonObjective(py::object f, Layout layout, Callbacks& callbacks)
    : f_(std::move(f)), layout_(std::move(layout)), callbacks_(callbacks) {}

PythonObjective::~PythonObjective() {
  const HeldGil lock;
  f_ = py::object();
}

Evaluation PythonObjective::evaluate(std::span<const double> x) {
  double value = std::numeric_limits<double>::infinity();
  callbacks_.call([&] { value = py::cast<double>(py::float_(f_.attr("value")(layout_.out(x)))); });
  if (std::isnan(value)) value = std::numeric_limits<double>::infinity();
  return {value, std::isfinite(value) ? 4 * std::numeric_limits<double>::epsilon() * std::abs(value) : 0};
}

void PythonObjective::gradient(std::span<const double> x, std::span<double> g) {
  std::fill(g.begin(), g.end(), 0.0);
  callbacks_.call([&] {
    const std::vector<double> found = layout_.in(f_.attr("gradient")(layout_.out(x)), "gradient", Finite::not_required);
    std::copy(found.begin(), found.end(), g.begin());
  });
  round_off_ = 4 * std::numeric_limits<double>::epsilon() * norm(g);
}

const BlockSparse& PythonObjective::evaluate_hessian(std::span<const double> x, const Projection& projection) {
  projected_elements_ = 0;
  callbacks_.call([&] { assemble(f_.attr("hessian")(layout_.out(x)), projection); });
  if (!H_) {  // an exception: any matrix
    pattern_ = make_pattern(layout_.rows(), {});
    H_ = std::make_unique<BlockSparse>(pattern_);
  }
  return *H_;
}

void PythonObjective::assemble(const py::object& matrix, const Projection& projection) {
  const py::ssize_t n = layout_.size();
  const bool is_sparse = py::hasattr(matrix, "tocoo"), is_exact = projection.kind == Definiteness::exact;
  if (!is_exact && n > kMaxModified)
    throw InvalidInput("hessian: of " + std::to_string(n) + " rows; eigenvalues are modified up to " +
                       std::to_string(kMaxModified) + " rows (use definiteness=\"exact\")");
  py::object entries;
  if (is_sparse && is_exact) {
    entries = matrix.attr("tocoo")();
  } else {
    Array dense = reals(is_sparse ? matrix.attr("toarray")() : matrix, "hessian", {n, n});
    if (!is_exact) {
      std::vector<double> A(view(dense).begin(), view(dense).end());
      projected_elements_ = modify_eigenvalues(static_cast<int>(n), A, projection.kind) ? 1 : 0;
      dense = to_array(A, {n, n});
    }
    entries = py::module_::import("scipy.sparse").attr("coo_matrix")(dense);
  }
  const std::vector<int> rows = indices(entries.attr("row"), "hessian.row", {-1}, n);
  const std::vector<int> columns = indices(entries.attr("col"), "hessian.col", {-1}, n);
  const Array data = reals(entries.attr("data"), "hessian", {static_cast<py::ssize_t>(rows.size())});
  Couplings couplings;
  for (size_t i = 0; i < rows.size(); ++i)
    if (rows[i] / 3 != columns[i] / 3) couplings.emplace_back(rows[i] / 3, columns[i] / 3);
  BlockPattern pattern = make_pattern(layout_.rows(), std::move(couplings));
  if (!H_ || pattern.row_start != pattern_.row_start || pattern.column != pattern_.column) {
    pattern_ = std::move(pattern);
    H_ = std::make_unique<BlockSparse>(pattern_);
  }
  H_->set_zero();
  for (size_t i = 0; i < rows.size(); ++i) {
    const int r = rows[i], c = columns[i];
    if (c / 3 > r / 3) continue;  // the lower triangle suffices
    H_->block[pattern_.slot(r / 3, c / 3)](r % 3, c % 3) += data.data()[i];
  }
  for (py::ssize_t i = n; i < 3 * layout_.rows(); ++i)
    H_->block[pattern_.diagonal(static_cast<int>(i / 3))](static_cast<int>(i % 3), static_cast<int>(i % 3)) = 1;
}

std::shared_ptr<PythonFunction> PythonFunction::make(const py::object& f, const py::object& x) {
  const Layout layout = layout_of(x);
  auto callbacks = std::make_shared<Callbacks>();
  auto E = std::make_unique<PythonObjective>(f, layout, *callbacks);
  return std::shared_ptr<PythonFunction>(new PythonFunction(std::move(E), layout, std::move(callbacks)));
}

}  // namespace aspic::python
