#include "fit/homogeneous.h"

#include <array>
#include <cmath>

#include "base/check.h"
#include "material/list.h"
#include "math/dual.h"

namespace aspic {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"uniaxial", "equibiaxial", "planar", "simple_shear"};

constexpr int kMaxStretchIterations = 100;
constexpr double kLargestStep = 0.3;  // per iteration, of ln t
constexpr double kTolerance = 1e-13;  // tolerance of ln t
constexpr double kMaxStretch = 1e12;  // limit of the search

Mat3d stretched(double x, double y, double z) { return {{x, 0, 0, 0, y, 0, 0, 0, z}}; }

struct Kinematics {
  Deformation deformation;
  double l;

  bool has_free_faces() const { return deformation != Deformation::simple_shear; }
  int free_axis() const { return deformation == Deformation::uniaxial ? 1 : 2; }
  int stress_entry() const { return deformation == Deformation::simple_shear ? 3 : 0; }  // in vec(P)

  Mat3d F(double t) const {
    if (deformation == Deformation::uniaxial) return stretched(l, t, t);
    if (deformation == Deformation::equibiaxial) return stretched(l, l, t);
    if (deformation == Deformation::planar) return stretched(l, 1, t);
    Mat3d F = identity3<double>();
    F(0, 1) = l;
    return F;
  }
  Mat3d dF_dt() const { return deformation == Deformation::uniaxial ? stretched(0, 1, 1) : stretched(0, 0, 1); }
  double isochoric_t() const {
    if (deformation == Deformation::uniaxial) return 1 / std::sqrt(l);
    return 1 / (deformation == Deformation::equibiaxial ? l * l : l);
  }
};

// Stress and its derivative with respect to parameter `k` of mu, lambda, extra... (k < 0: in direction dF).
template <class M>
Mat3<Dual<double>> stress_and_rate(const Mat3d& F, const Mat3d& dF, const MaterialParameters& m, int k) {
  using Real = Dual<double>;
  MaterialParametersOver<Real> p;
  p.lame = {Real(m.lame.mu, k == 0), Real(m.lame.lambda, k == 1)};
  for (int e = 0; e < kMaxExtraParameters; ++e) p.extra[e] = Real(m.extra[e], k == 2 + e);
  return M::pk1(dual_matrix(F, dF), M::params(p));
}

// Solves for ln t with traction-free faces by Newton's method with short steps. Uses t P_tt, which keeps the sign of
// the traction and is bounded as t -> 0.
template <class M>
bool find_free_stretch(const Kinematics& body, const MaterialParameters& m, double& t) {
  const int axis = body.free_axis();
  for (int i = 0; i < kMaxStretchIterations; ++i) {
    const Mat3<Dual<double>> P = stress_and_rate<M>(body.F(t), t * body.dF_dt(), m, -1);
    const double traction = P(axis, axis).value, slope = P(axis, axis).rate;
    const double rate = traction + slope;  // derivative of t P_tt / t by ln t
    double step = rate > 0 ? -traction / rate : -std::copysign(kLargestStep, traction);
    if (!std::isfinite(step)) return false;
    step = std::fmax(-kLargestStep, std::fmin(kLargestStep, step));
    t *= std::exp(step);
    if (std::abs(std::log(t)) > std::log(kMaxStretch)) return false;
    if (std::abs(step) <= kTolerance) return true;
  }
  return false;
}

template <class M>
HomogeneousState state(const MaterialParameters& m, const Kinematics& body, Volume volume) {
  HomogeneousState s;
  const int count = 2 + static_cast<int>(M::info().extra.size()), entry = body.stress_entry();
  double t = body.isochoric_t();
  const bool relaxes = body.has_free_faces() && volume == Volume::compressible;
  if (relaxes && !find_free_stretch<M>(body, m, t)) return s;
  s.F = body.F(t);
  // The incompressible body has the stress P - p cof F; on diagonals cof_11 / cof_tt = t / l.
  const int free = body.has_free_faces() ? 4 * body.free_axis() : -1;
  const double pressure_ratio = volume == Volume::incompressible && free >= 0 ? t / body.l : 0;
  const auto measured = [&](auto&& of) { return of(entry) - (pressure_ratio > 0 ? pressure_ratio * of(free) : 0.0); };

  const Mat3<Dual<double>> along = stress_and_rate<M>(s.F, body.dF_dt(), m, -1);
  s.stress = measured([&](int i) { return along.a[i].value; });
  for (int k = 0; k < count; ++k) {
    const Mat3<Dual<double>> P = stress_and_rate<M>(s.F, Mat3d{}, m, k);
    double slope = measured([&](int i) { return P.a[i].rate; });
    if (relaxes)
      slope -= along.a[entry].rate * P.a[free].rate / along.a[free].rate;  // dt/dtheta = -P_tt,theta / P_tt,t
    s.slopes.push_back(slope);
  }
  s.is_found = std::isfinite(s.stress);
  for (const double slope : s.slopes) s.is_found &= std::isfinite(slope);
  return s;
}

}  // namespace

std::string_view name(Deformation deformation) { return kNames[static_cast<size_t>(deformation)]; }

std::vector<std::string> deformation_names() { return {kNames.begin(), kNames.end()}; }

Deformation deformation_named(std::string_view name) {
  for (size_t i = 0; i < kNames.size(); ++i)
    if (kNames[i] == name) return static_cast<Deformation>(i);
  throw InvalidInput("the test '" + std::string(name) + "' is unknown" + suggestion(name, deformation_names()));
}

HomogeneousState homogeneous_state(std::string_view material, const MaterialParameters& parameters,
                                   Deformation deformation, double stretch, Volume volume) {
  ASPIC_CHECK(stretch > 0 || deformation == Deformation::simple_shear);
  HomogeneousState found;
  with_material(material, [&]<class M>() { found = state<M>(parameters, {deformation, stretch}, volume); });
  return found;
}

}  // namespace aspic
