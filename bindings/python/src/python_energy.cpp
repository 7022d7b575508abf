#include "python_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "arrays.h"
#include "base/error.h"
#include "eigenvalues.h"

namespace aspic::python {
namespace {

class PythonEnergy : public SteadyEnergy {
 public:
  PythonEnergy(const py::object& energy, const Renumbering& vertex, int vertex_count,
               std::shared_ptr<Callbacks> callbacks)
      : energy_(energy), callbacks_(std::move(callbacks)) {
    for (const char* method : {"value", "gradient", "hessian"})
      if (!py::hasattr(energy, method) || !PyCallable_Check(energy.attr(method).ptr()))
        throw InvalidInput("energy '" + py::type::of(energy).attr("__name__").cast<std::string>() + "' has no method " +
                           method + "(x)");
    name_ = py::hasattr(energy, "name") ? std::string(py::str(energy.attr("name")))
                                        : py::type::of(energy).attr("__name__").cast<std::string>();
    if (!py::hasattr(energy, "elements"))
      throw InvalidInput("energy '" + name_ + "' needs `elements`, an array (E, k) of vertices");
    const py::object elements = energy.attr("elements");
    vertices_ = indices(elements, "energy '" + name_ + "': elements", {-1, -1}, vertex_count);
    corners_ = static_cast<int>(py::array(elements).shape(1));
    if (vertices_.empty()) throw InvalidInput("energy '" + name_ + "': elements is empty");
    for (size_t i = 0; i < vertices_.size(); i += static_cast<size_t>(corners_)) {
      std::vector<int> element(vertices_.begin() + static_cast<std::ptrdiff_t>(i),
                               vertices_.begin() + static_cast<std::ptrdiff_t>(i) + corners_);
      std::sort(element.begin(), element.end());
      if (std::adjacent_find(element.begin(), element.end()) != element.end())
        throw InvalidInput("energy '" + name_ + "': elements[" + std::to_string(i / corners_) +
                           "] names a vertex twice");
    }
    for (int& v : vertices_) v = vertex.from_user(v);
  }

  ~PythonEnergy() override {
    const HeldGil lock;
    energy_ = py::object();
  }

  using SteadyEnergy::add_gradient, SteadyEnergy::add_hessian, SteadyEnergy::value;
  std::string_view name() const override { return name_; }

  void add_couplings(Couplings& couplings) const override {
    for (int e = 0; e < count(); ++e)
      for (int i = 1; i < corners_; ++i)
        for (int j = 0; j < i; ++j) couplings.emplace_back(vertex(e, i), vertex(e, j));
  }

  void bind(const BlockPattern& pattern) override {
    slots_.clear();
    for (int e = 0; e < count(); ++e)
      for (int i = 0; i < corners_; ++i)
        for (int j = 0; j < corners_; ++j)
          slots_.push_back(vertex(e, j) <= vertex(e, i) ? pattern.slot(vertex(e, i), vertex(e, j)) : -1);
  }

  double value(Positions x, const Context&) const override {
    double sum = 0;
    const bool ok = compute("value", x, {count()}, Finite::not_required, [&](std::span<const double> values) {
      for (const double value : values) sum += value;
    });
    return ok && std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
  }

  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    compute("gradient", x, {count(), corners_, 3}, Finite::required, [&](std::span<const double> values) {
      for (size_t i = 0; i < vertices_.size(); ++i)
        for (size_t r = 0; r < 3; ++r) g[3 * static_cast<size_t>(vertices_[i]) + r] += scale * values[3 * i + r];
    });
  }

  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    int modified = 0;
    compute("hessian", x, {count(), corners_, 3, corners_, 3}, Finite::required, [&](std::span<const double> values) {
      const size_t n = 3 * static_cast<size_t>(corners_);
      for (int e = 0; e < count(); ++e) {
        const std::span<const double> given = values.subspan(static_cast<size_t>(e) * n * n, n * n);
        std::vector<double> A(given.begin(), given.end());
        if (is_covered(e, projection) && modify_eigenvalues(static_cast<int>(n), A, projection.kind)) ++modified;
        add_element(e, A, scale, H);
      }
    });
    return modified;
  }

 private:
  int count() const { return static_cast<int>(vertices_.size()) / corners_; }
  int vertex(int element, int corner) const { return vertices_[static_cast<size_t>(element) * corners_ + corner]; }

  // Calls the method with a fresh array, and `use` with its result.
  template <class Use>
  bool compute(const char* method, Positions x, const Shape& shape, Finite finite, const Use& use) const {
    return callbacks_->call([&] {
      Array corners(Shape{count(), corners_, 3});
      double* at = corners.mutable_data();
      for (const int v : vertices_)
        for (int r = 0; r < 3; ++r) *at++ = x[3 * static_cast<size_t>(v) + static_cast<size_t>(r)];
      use(view(reals(energy_.attr(method)(corners), name_ + "." + method, shape, finite)));
    });
  }

  bool is_covered(int element, const Projection& projection) const {
    for (int i = 0; i < corners_; ++i)
      if (projection.covers(vertex(element, i))) return true;
    return false;
  }

  void add_element(int element, const std::vector<double>& A, double scale, BlockSparse& H) const {
    const int n = 3 * corners_;
    for (int i = 0; i < corners_; ++i)
      for (int j = 0; j < corners_; ++j) {
        const int64_t slot = slots_[(static_cast<size_t>(element) * corners_ + i) * corners_ + j];
        if (slot < 0) continue;
        for (int r = 0; r < 3; ++r)
          for (int c = 0; c < 3; ++c) H.block[slot](r, c) += scale * A[(3 * i + r) * n + 3 * j + c];
      }
  }

  py::object energy_;
  std::shared_ptr<Callbacks> callbacks_;
  std::string name_;
  int corners_ = 0;
  std::vector<int> vertices_;   // of the model, corners_ per element
  std::vector<int64_t> slots_;  // of the blocks of each element; -1: above the diagonal
};

}  // namespace

std::unique_ptr<Energy> make_python_energy(const py::object& energy, const Renumbering& vertex, int vertex_count,
                                           std::shared_ptr<Callbacks> callbacks) {
  return std::make_unique<PythonEnergy>(energy, vertex, vertex_count, std::move(callbacks));
}

}  // namespace aspic::python
