#include "model/parameter_map.h"

#include <algorithm>

#include "base/check.h"
#include "base/error.h"
#include "base/formatted.h"
#include "base/parallel.h"
#include "model/quantity.h"
#include "model/quantity_scale.h"
#include "model/tangent_frame.h"

namespace aspic {
namespace {

// Internal representation of a fitted quantity.
struct Fitted {
  QuantityRole role = QuantityRole::stiffness;
  int extra = 0;  // index into MaterialParameters::extra; of a tilt: 0 or 1
  QuantityScale scale;
  FieldBasis basis;
  int first = 0;  // index of its first entry in p
  double guess = 0;

  std::span<const double> part(std::span<const double> p) const { return p.subspan(first, basis.size()); }
  std::span<double> part(std::span<double> p) const { return p.subspan(first, basis.size()); }
  std::vector<double> field(std::span<const double> p) const {
    std::vector<double> z(basis.tet_count());
    basis.multiply(part(p), z);
    return z;
  }
};

// E = mu (3 la + 2 mu) / (la + mu) and nu from and to mu and lambda.
struct Elastic {
  double young, poisson;

  Lame lame() const { return lame_from_young_poisson(young, poisson); }
  Lame slope_young() const { return lame_from_young_poisson(1, poisson); }
  Lame slope_poisson() const {
    const double a = 1 + poisson, b = 1 - 2 * poisson;
    return {-young / (2 * a * a), young * (1 + 2 * poisson * poisson) / (a * a * b * b)};
  }
};

void check_guess(const FitParameter& u, const Quantity& q) {
  if (u.guess > q.min && u.guess < q.max) return;
  const std::string guess = "the guess of '" + u.quantity + "' is " + six_digits(u.guess);
  if (q.role == QuantityRole::stiffness) throw InvalidInput(guess + " Pa; it must be positive");
  throw InvalidInput(guess + "; it must lie between " + six_digits(q.min) + " and " + six_digits(q.max) +
                     ", and not at an end");
}

// Ranges over two powers of ten or more use logarithms.
QuantityScale scale_of(const ExtraParameter& extra) {
  constexpr double kPowers = 100;
  if (extra.min == 0 && extra.max > kPowers) return QuantityScale::powers_from_zero(extra.max);
  const bool powers = extra.min > 0 && extra.max > kPowers * extra.min;
  return powers ? QuantityScale::bounded_powers(extra.min, extra.max) : QuantityScale::bounded(extra.min, extra.max);
}

void set_quantity(const FitParameter& u, const MaterialInfo& info, Fitted& f) {
  const Quantity q = material_quantity(info.name, u.quantity);
  if (q.role == QuantityRole::component)
    throw InvalidInput("'" + u.quantity + "' is a component of a direction; fit " + kFibreDirection + " instead");
  check_guess(u, q);
  f.role = q.role;
  f.extra = q.extra;
  if (q.role == QuantityRole::compressibility) f.scale = QuantityScale::bounded(q.min, q.max);
  if (q.role == QuantityRole::tilt) f.scale = QuantityScale::any();
  if (q.role == QuantityRole::own) f.scale = scale_of(info.extra[static_cast<size_t>(q.extra)]);
}

FieldBasis make_basis(const TetMesh& mesh, const FitParameter& u) {
  switch (u.parameterization) {
    case Parameterization::uniform:
      return FieldBasis::uniform(mesh.tet_count());
    case Parameterization::regions:
      if (mesh.region.empty())
        throw InvalidInput("'" + u.quantity + "' is fitted per region, but the mesh has none (try uniform or handles)");
      return FieldBasis::regions(mesh.region);
    case Parameterization::handles:
      if (u.handles < 1 || u.handles > mesh.tet_count())
        throw InvalidInput("'" + u.quantity + "' is fitted at " + std::to_string(u.handles) + " handles; use 1 to " +
                           std::to_string(mesh.tet_count()) + ", one per tet");
      return FieldBasis::radial(mesh, u.handles);
    case Parameterization::tets:
      break;
  }
  return FieldBasis::tets(mesh.tet_count());
}

}  // namespace

struct ParameterMap::Impl {
  std::string material;
  int per_tet = 2;
  std::vector<MaterialParameters> known;
  std::vector<Elastic> elastic;  // elastic constants of `known`
  std::vector<FitParameter> parameters;
  std::vector<Fitted> fitted;
  std::vector<double> guess;

  int first_component = 0;  // of the direction of fibres, in MaterialParameters::extra

  Vec3d direction_of(const MaterialParameters& m) const {
    return {{m.extra[first_component], m.extra[first_component + 1], m.extra[first_component + 2]}};
  }
  // Part of the direction in a list of mu, lambda, extra...
  Vec3d direction_part(const double* theta) const {
    const double* a = theta + 2 + first_component;
    return {{a[0], a[1], a[2]}};
  }

  const Fitted* find(QuantityRole role) const {
    const auto found = std::find_if(fitted.begin(), fitted.end(), [&](const Fitted& f) { return f.role == role; });
    return found == fitted.end() ? nullptr : &*found;
  }

  // dtheta/dz of one quantity in every tet.
  struct Slopes {
    std::vector<Lame> lame;        // of E and nu
    std::vector<double> extra;     // of an extra
    std::vector<Vec3d> direction;  // of a tilt
  };
  Slopes slopes(const Fitted& f, std::span<const double> p) const;
  std::vector<Elastic> elastic_at(std::span<const double> p) const;
  // Calls visit(tet, frame, u, v) for the tilts of each tet.
  template <class Visit>
  void for_each_tilt(std::span<const double> p, const Visit& visit) const;
  void check_directions() const;
};

template <class Visit>
void ParameterMap::Impl::for_each_tilt(std::span<const double> p, const Visit& visit) const {
  std::vector<double> tilt[2];
  for (const Fitted& f : fitted)
    if (f.role == QuantityRole::tilt) tilt[f.extra] = f.field(p);
  for (size_t t = 0; t < known.size(); ++t) visit(t, TangentFrame(direction_of(known[t])), tilt[0][t], tilt[1][t]);
}

// Both tilts are fitted, or none, and there is a reference direction.
void ParameterMap::Impl::check_directions() const {
  const auto tilts =
      std::count_if(fitted.begin(), fitted.end(), [](const Fitted& f) { return f.role == QuantityRole::tilt; });
  if (tilts == 0) return;
  ASPIC_CHECK(tilts == 2);
  for (const MaterialParameters& m : known) ASPIC_CHECK(norm(direction_of(m)) > 0);
}

std::vector<Elastic> ParameterMap::Impl::elastic_at(std::span<const double> p) const {
  std::vector<Elastic> e = elastic;
  for (const Fitted& f : fitted) {
    if (f.role != QuantityRole::stiffness && f.role != QuantityRole::compressibility) continue;
    const std::vector<double> z = f.field(p);
    parallel_chunks(static_cast<int>(z.size()), [&](int first, int last) {
      for (int t = first; t < last; ++t)
        (f.role == QuantityRole::stiffness ? e[t].young : e[t].poisson) = f.scale.value(z[t]);
    });
  }
  return e;
}

ParameterMap::Impl::Slopes ParameterMap::Impl::slopes(const Fitted& f, std::span<const double> p) const {
  const std::vector<double> z = f.field(p);
  const int tets = static_cast<int>(z.size());
  Slopes slopes;
  if (f.role == QuantityRole::tilt) {
    slopes.direction.resize(z.size());
    for_each_tilt(p, [&](size_t t, const TangentFrame& frame, double u, double v) {
      slopes.direction[t] = frame.slope(f.extra, u, v);
    });
    return slopes;
  }
  if (f.role == QuantityRole::own) {
    slopes.extra.resize(z.size());
    parallel_chunks(tets, [&](int first, int last) {
      for (int t = first; t < last; ++t) slopes.extra[t] = f.scale.slope(z[t]);
    });
    return slopes;
  }
  const std::vector<Elastic> e = elastic_at(p);
  slopes.lame.resize(z.size());
  parallel_chunks(tets, [&](int first, int last) {
    for (int t = first; t < last; ++t) {
      const double dq = f.scale.slope(z[t]);
      const Lame d = f.role == QuantityRole::stiffness ? e[t].slope_young() : e[t].slope_poisson();
      slopes.lame[t] = {d.mu * dq, d.lambda * dq};
    }
  });
  return slopes;
}

ParameterMap::ParameterMap(const TetMesh& mesh, std::string material, std::vector<MaterialParameters> known,
                           std::vector<FitParameter> parameters)
    : impl_(std::make_unique<Impl>()) {
  ASPIC_CHECK(static_cast<int>(known.size()) == mesh.tet_count());
  const MaterialInfo& info = material_info(material);
  impl_->material = std::move(material);
  impl_->per_tet = 2 + static_cast<int>(info.extra.size());
  impl_->first_component = fibre_components(info.name).value_or(0);
  impl_->known = std::move(known);
  for (const MaterialParameters& m : impl_->known)
    impl_->elastic.push_back({young_modulus(m.lame), poisson_ratio(m.lame)});
  if (parameters.empty()) throw InvalidInput("there is no parameter to fit (try young)");
  for (const FitParameter& u : parameters) {
    for (const FitParameter& other : impl_->parameters)
      if (other.quantity == u.quantity) throw InvalidInput("'" + u.quantity + "' is fitted twice");
    Fitted f;
    set_quantity(u, info, f);
    f.basis = make_basis(mesh, u);
    f.first = static_cast<int>(impl_->guess.size());
    f.guess = f.scale.fitted(u.guess);
    impl_->guess.insert(impl_->guess.end(), static_cast<size_t>(f.basis.size()), f.guess);
    impl_->fitted.push_back(std::move(f));
    impl_->parameters.push_back(u);
  }
  impl_->check_directions();
}

ParameterMap::~ParameterMap() = default;
ParameterMap::ParameterMap(ParameterMap&&) noexcept = default;

int ParameterMap::size() const { return static_cast<int>(impl_->guess.size()); }
int ParameterMap::tet_count() const { return static_cast<int>(impl_->known.size()); }
int ParameterMap::parameters_per_tet() const { return impl_->per_tet; }
const std::vector<FitParameter>& ParameterMap::fitted_parameters() const { return impl_->parameters; }
const std::string& ParameterMap::material() const { return impl_->material; }
std::span<const double> ParameterMap::guess() const { return impl_->guess; }
std::pair<int, int> ParameterMap::range(int parameter) const {
  const Fitted& f = impl_->fitted[parameter];
  return {f.first, f.basis.size()};
}
const FieldBasis& ParameterMap::basis(int parameter) const { return impl_->fitted[parameter].basis; }

std::vector<MaterialParameters> ParameterMap::parameters(std::span<const double> p) const {
  ASPIC_CHECK(static_cast<int>(p.size()) == size());
  std::vector<MaterialParameters> theta = impl_->known;
  const int tets = static_cast<int>(theta.size());
  if (impl_->find(QuantityRole::stiffness) || impl_->find(QuantityRole::compressibility)) {
    const std::vector<Elastic> e = impl_->elastic_at(p);
    parallel_chunks(tets, [&](int first, int last) {
      for (int t = first; t < last; ++t) theta[t].lame = e[t].lame();
    });
  }
  for (const Fitted& f : impl_->fitted) {
    if (f.role != QuantityRole::own) continue;
    const std::vector<double> z = f.field(p);
    for (int t = 0; t < tets; ++t) theta[t].extra[f.extra] = f.scale.value(z[t]);
  }
  if (impl_->find(QuantityRole::tilt))
    impl_->for_each_tilt(p, [&](size_t t, const TangentFrame& frame, double u, double v) {
      const Vec3d a = frame.direction(u, v);
      for (int r = 0; r < 3; ++r) theta[t].extra[impl_->first_component + r] = a[r];
    });
  return theta;
}

void ParameterMap::multiply(std::span<const double> p, std::span<const double> dp, std::span<double> dtheta) const {
  const int n = impl_->per_tet, tets = static_cast<int>(impl_->known.size());
  ASPIC_CHECK(static_cast<int>(dp.size()) == size() && dtheta.size() == static_cast<size_t>(n) * tets);
  std::fill(dtheta.begin(), dtheta.end(), 0.0);
  for (const Fitted& f : impl_->fitted) {
    const Impl::Slopes slopes = impl_->slopes(f, p);
    const std::vector<double> dz = f.field(dp);
    parallel_chunks(tets, [&](int first, int last) {
      for (int t = first; t < last; ++t) {
        double* d = dtheta.data() + static_cast<size_t>(n) * t;
        if (f.role == QuantityRole::own)
          d[2 + f.extra] += slopes.extra[t] * dz[t];
        else if (f.role == QuantityRole::tilt)
          for (int r = 0; r < 3; ++r) d[2 + impl_->first_component + r] += slopes.direction[t][r] * dz[t];
        else
          d[0] += slopes.lame[t].mu * dz[t], d[1] += slopes.lame[t].lambda * dz[t];
      }
    });
  }
}

void ParameterMap::add_transposed(std::span<const double> p, std::span<const double> thetabar,
                                  std::span<double> pbar) const {
  const int n = impl_->per_tet, tets = static_cast<int>(impl_->known.size());
  ASPIC_CHECK(static_cast<int>(pbar.size()) == size() && thetabar.size() == static_cast<size_t>(n) * tets);
  std::vector<double> zbar(tets);
  for (const Fitted& f : impl_->fitted) {
    const Impl::Slopes slopes = impl_->slopes(f, p);
    parallel_chunks(tets, [&](int first, int last) {
      for (int t = first; t < last; ++t) {
        const double* d = thetabar.data() + static_cast<size_t>(n) * t;
        if (f.role == QuantityRole::own)
          zbar[t] = slopes.extra[t] * d[2 + f.extra];
        else if (f.role == QuantityRole::tilt)
          zbar[t] = dot(slopes.direction[t], impl_->direction_part(d));
        else
          zbar[t] = slopes.lame[t].mu * d[0] + slopes.lame[t].lambda * d[1];
      }
    });
    f.basis.add_transposed(zbar, f.part(pbar));
  }
}

std::vector<double> ParameterMap::fitted_values(int parameter, std::span<const double> p) const {
  return impl_->fitted[parameter].field(p);
}

std::vector<double> ParameterMap::values(int parameter, std::span<const double> p) const {
  const Fitted& f = impl_->fitted[parameter];
  std::vector<double> q = f.field(p);
  for (double& x : q) x = f.scale.value(x);
  return q;
}

double ParameterMap::value(int parameter, double fitted) const { return impl_->fitted[parameter].scale.value(fitted); }

double ParameterMap::place_in_range(int parameter, double fitted) const {
  return impl_->fitted[parameter].scale.place_in_range(fitted);
}

void ParameterMap::multiply_fitted(int parameter, std::span<const double> dp, std::span<double> values) const {
  const Fitted& f = impl_->fitted[parameter];
  f.basis.multiply(f.part(dp), values);
}

void ParameterMap::add_fitted_transposed(int parameter, std::span<const double> values, std::span<double> pbar) const {
  const Fitted& f = impl_->fitted[parameter];
  f.basis.add_transposed(values, f.part(pbar));
}

}  // namespace aspic
