// Hessians as scipy matrices, and linear solvers.
#include "linalg/linear_solver.h"

#include <pybind11/stl.h>

#include "base/error.h"
#include "bindings.h"
#include "function.h"

namespace aspic::python {
namespace {

// Calls visit(row, column, block) for the blocks of both triangles. Pairs may repeat.
template <class Visit>
void for_each_block(const BlockSparse& H, const Visit& visit) {
  const BlockPattern& pattern = *H.pattern;
  for (int row = 0; row < pattern.rows(); ++row)
    for (int64_t slot = pattern.row_start[row]; slot < pattern.row_start[row + 1]; ++slot) {
      const int column = pattern.column[slot];
      visit(row, column, H.block[slot]);
      if (column != row) visit(column, row, transpose(H.block[slot]));
    }
  for (const Stencil& stencil : H.stencils)
    aspic::for_each_block(stencil, [&](int row, int column, const Mat3d& K) {
      visit(row, column, K);
      visit(column, row, transpose(K));
    });
}

// The matrix as (values, rows, columns) of scalars in the order of the user, without the padding of block rows.
py::object to_scipy(const Hessian& self) {
  std::vector<double> values;
  std::vector<int> rows, columns;
  const auto size = static_cast<int>(self.layout.size());
  {
    const ReleasedGil free;
    for_each_block(self.H, [&](int row, int column, const Mat3d& K) {
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
          const int r = 3 * self.layout.vertex.to_user(row) + i, c = 3 * self.layout.vertex.to_user(column) + j;
          if (r >= size || c >= size) continue;
          values.push_back(K(i, j));
          rows.push_back(r);
          columns.push_back(c);
        }
    });
  }
  const py::ssize_t n = static_cast<py::ssize_t>(values.size());
  const py::object entries =
      py::module_::import("scipy.sparse")
          .attr("coo_matrix")(
              py::make_tuple(to_array(values, {n}), py::make_tuple(to_array(rows, {n}), to_array(columns, {n}))),
              py::make_tuple(size, size));
  return entries.attr("tocsr")();
}

Array multiply(const Hessian& self, const py::handle& x) {
  const std::vector<double> in = self.layout.in(x, "x");
  std::vector<double> out(in.size());
  {
    const ReleasedGil free;
    self.H.multiply(in, out);
  }
  return self.layout.out(out);
}

[[noreturn]] void raise_not_definite(const std::string& what) {
  const py::object type = py::module_::import("numpy.linalg").attr("LinAlgError");
  PyErr_SetString(type.ptr(), what.c_str());
  throw py::error_already_set();
}

class Solver {
 public:
  explicit Solver(const std::string& method, int solves) : solver_(make_linear_solver(method, solves)) {}

  void factorize(std::shared_ptr<const Hessian> matrix) {
    const Use use(occupancy_, "solver");
    bool ok = false;
    {
      const ReleasedGil free;
      if (!matrix_ || matrix_->pattern->version != matrix->pattern->version) {
        solver_->analyze(*matrix->pattern);
        analyzed_ = matrix->pattern;
      }
      matrix_ = std::move(matrix);
      ok = solver_->factorize(matrix_->H);
    }
    if (!ok) {
      matrix_ = nullptr;
      raise_not_definite("the matrix is not positive definite; use E.hessian(q, \"clamped\")");
    }
  }

  Array solve(const py::handle& right, double tolerance) {
    const Use use(occupancy_, "solver");
    if (!matrix_) throw std::runtime_error("solve() needs factorize(H) first");
    const std::vector<double> b = matrix_->layout.in(right, "b");
    std::vector<double> x(b.size());
    SolveReport report;
    {
      const ReleasedGil free;
      report = solver_->solve(b, x, tolerance);
    }
    last_ = report;
    if (report.indefinite) raise_not_definite("the solver found negative curvature; use E.hessian(q, \"clamped\")");
    return matrix_->layout.out(x);
  }

  std::string description() const { return solver_->description(); }
  const SolveReport& last() const { return last_; }

 private:
  std::unique_ptr<LinearSolver> solver_;
  std::shared_ptr<const BlockPattern> analyzed_;
  std::shared_ptr<const Hessian> matrix_;
  SolveReport last_;
  Occupancy occupancy_;
};

}  // namespace

Definiteness definiteness_named(const std::string& name) {
  const std::vector<std::string> names = {"exact", "clamped", "absolute"};
  for (size_t i = 0; i < names.size(); ++i)
    if (names[i] == name) return static_cast<Definiteness>(i);
  throw InvalidInput("definiteness: unknown name '" + name + "'" + suggestion(name, names));
}

void bind_linalg(py::module_& m) {
  py::class_<Hessian, std::shared_ptr<Hessian>>(m, "Hessian", "A symmetric sparse matrix.")
      .def("to_scipy", &to_scipy, "Returns a scipy CSR matrix for vectors q.ravel().")
      .def(
          "__matmul__", [](const Hessian& self, const py::object& x) { return multiply(self, x); },
          "H @ x for an array of the shape of x.")
      .def_property_readonly(
          "shape", [](const Hessian& self) { return py::make_tuple(self.layout.size(), self.layout.size()); });
  py::class_<Solver>(m, "LinearSolver",
                     "Solves H x = b for a positive definite H: 'auto', 'cholesky', 'multigrid' or 'block_jacobi'.")
      .def(py::init<const std::string&, int>(), py::arg("method") = "auto", py::arg("solves") = 1)
      .def(
          "factorize",
          [](const py::object& self, std::shared_ptr<Hessian> H) {
            self.cast<Solver&>().factorize(std::move(H));
            return self;
          },
          py::arg("H").none(false),
          "Factorizes H and returns the solver. Raises LinAlgError unless H is positive definite.")
      .def(
          "solve", [](Solver& self, const py::object& b, double tolerance) { return self.solve(b, tolerance); },
          py::arg("b"), py::arg("tolerance") = 1e-10,
          "Returns x with H x = b, in the shape of b. Direct solvers ignore the tolerance.")
      .def_property_readonly("description", &Solver::description)
      .def_property_readonly("iterations", [](const Solver& self) { return self.last().iterations; });
  m.def("linear_solver_names", &linear_solver_names);
}

}  // namespace aspic::python
