// Stresses of the registered materials and their derivatives, for curves of homogeneous deformation.
#include "material/registry.h"

#include <pybind11/stl.h>

#include <algorithm>

#include "arrays.h"
#include "base/error.h"
#include "bindings.h"
#include "material/list.h"
#include "math/dual.h"

namespace aspic::python {
namespace {

// mu, lambda and the material's own parameters.
size_t parameter_count(const MaterialInfo& info) { return 2 + info.extra.size(); }

// Stress and its derivative with respect to parameter `k` (k < 0: in direction dF).
template <class M>
Mat3<Dual<double>> stress_and_rate(const Mat3d& F, const Mat3d& dF, const std::vector<double>& theta, int k) {
  using Real = Dual<double>;
  MaterialParametersOver<Real> p;
  p.lame = {Real(theta[0], k == 0), Real(theta[1], k == 1)};
  for (int i = 2; i < static_cast<int>(theta.size()); ++i) p.extra[i - 2] = Real(theta[i], k == i);
  return M::pk1(dual_matrix(F, dF), M::params(p));
}

Mat3d matrix_at(std::span<const double> rows, size_t i) {
  Mat3d m;
  for (int a = 0; a < 3; ++a)
    for (int b = 0; b < 3; ++b) m(a, b) = rows[9 * i + 3 * a + b];
  return m;
}

// P (n, 3, 3) of F (n, 3, 3), its derivative in direction dF, and those by all parameters, (parameters, n, 3, 3).
py::tuple material_stress(const std::string& model, const std::vector<double>& theta, const py::handle& F,
                          const py::handle& dF) {
  const MaterialInfo& info = material_info(model);
  if (theta.size() != parameter_count(info))
    throw InvalidInput("parameters of " + model + ": " + std::to_string(theta.size()) +
                       " numbers; it has mu, lambda and " + std::to_string(info.extra.size()) + " of its own");
  const Shape shape = shape_of(py::array::ensure(F));
  if (shape.size() != 3) throw InvalidInput("F has the shape " + text_of(shape) + "; (n, 3, 3) is expected");
  const Array f = reals(F, "F", {shape[0], 3, 3}), df = reals(dF, "dF", {shape[0], 3, 3});
  const auto n = static_cast<size_t>(shape[0]);
  std::vector<double> stress(9 * n), along(9 * n), slopes(9 * n * theta.size());
  with_material(model, [&]<class M>() {
    for (int k = -1; k < static_cast<int>(theta.size()); ++k)
      for (size_t i = 0; i < n; ++i) {
        const Mat3d direction = k < 0 ? matrix_at(view(df), i) : Mat3d{};
        const Mat3<Dual<double>> P = stress_and_rate<M>(matrix_at(view(f), i), direction, theta, k);
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b) {
            const size_t at = 9 * i + 3 * a + b;
            if (k < 0) stress[at] = P(a, b).value;
            (k < 0 ? along[at] : slopes[9 * n * k + at]) = P(a, b).rate;
          }
      }
  });
  const Shape points = {shape[0], 3, 3};
  return py::make_tuple(to_array(stress, points), to_array(along, points),
                        to_array(slopes, {static_cast<py::ssize_t>(theta.size()), shape[0], 3, 3}));
}

py::list material_parameters(const std::string& model) {
  py::list list;
  for (const ExtraParameter& e : material_info(model).extra)
    list.append(py::make_tuple(e.name, e.unit, e.fallback, e.min, e.max));
  return list;
}

}  // namespace

void bind_material(py::module_& m) {
  m.def("material_stress", &material_stress);
  m.def("material_parameters", &material_parameters, "Name, unit, default and range of each parameter besides moduli.");
  m.def("is_isotropic", [](const std::string& model) {
    const auto& extra = material_info(model).extra;
    return std::none_of(extra.begin(), extra.end(), [](const auto& e) { return e.name == "fibre_x"; });
  });
}

}  // namespace aspic::python
