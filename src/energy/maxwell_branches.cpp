#include "energy/maxwell_branches.h"

#include "energy/internal_variables.h"
#include "energy/maxwell_factors.h"
#include "energy/quadratic_batch.h"
#include "energy/tet_term.h"
#include "material/second_piola.h"

namespace aspic {
namespace {

// A symmetric matrix: xx yy zz xy yz zx.
template <class T>
using Six = std::array<T, 6>;

template <class T>
Six<T> six_of(const Mat3<T>& m) {
  return {m(0, 0), m(1, 1), m(2, 2), m(0, 1), m(1, 2), m(2, 0)};
}
template <class T>
Pack squared(const Six<T>& m) {
  return m[0] * m[0] + m[1] * m[1] + m[2] * m[2] + Pack(2.0) * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5]);
}

// psi(F) = k |E - E_0|^2 + c : (E - E_0), E = (F'F - I) / 2, with the sums k of G phi and c of exp(-x) s_0 over the
// branches. P = F S, S = 2 k (E - E_0) + c.
struct MaxwellStep {
  template <class T>
  struct Params {
    T k;         // [Pa]
    Six<T> E_0;  // [1]
    Six<T> c;    // [Pa]
  };

  template <class T>
  static Mat3<T> green_strain(const Mat3<T>& F) {
    return T(0.5) * (transpose(F) * F - identity3<T>());
  }
  template <class T>
  static Mat3<T> matrix(const Six<T>& m) {
    return {{m[0], m[3], m[5], m[3], m[1], m[4], m[5], m[4], m[2]}};
  }
  template <class T>
  static Mat3<T> stress(const Mat3<T>& F, const Params<T>& p) {
    return T(2.0) * p.k * (green_strain(F) - matrix(p.E_0)) + matrix(p.c);
  }

  template <class T>
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const Mat3<T> change = green_strain(F) - matrix(p.E_0);
    return p.k * squared_norm(change) + inner(matrix(p.c), change);
  }
  template <class T>
  static Mat3<T> pk1(const Mat3<T>& F, const Params<T>& p) {
    return F * stress(F, p);
  }
  template <class T>
  static Mat9<T> hessian(const Mat3<T>& F, const Params<T>& p) {
    Mat9<T> H{};
    add_product_hessian(F, stress(F, p), p.k, H);
    return H;
  }
};

template <class Batch>
class MaxwellTerm final : public TetTerm<MaxwellStep, Energy, Batch>, public InternalVariables {
  using Term = TetTerm<MaxwellStep, Energy, Batch>;
  using Context = Energy::Context;
  using Params = MaxwellStep::Params<Pack>;
  using Stress = Six<Pack>;
  using Term::at, Term::batch_count, Term::batches_, Term::F, Term::kPoints, Term::params_, Term::place, Term::reduce;

 public:
  MaxwellTerm(std::string name, const TetMesh& mesh, int first, std::vector<MaxwellBranch> branches)
      : Term(std::move(name), mesh, first, std::vector<MaxwellStep::Params<double>>(branches[0].shear.size())),
        first_(first),
        tet_count_(static_cast<int>(branches[0].shear.size())),
        shear_(branches.size()) {
    for (size_t b = 0; b < branches.size(); ++b) {
      times_.push_back(branches[b].relaxation_time);
      for (int i = 0; i < batch_count(); ++i) {
        Pack G;
        for (int l = 0; l < kPackWidth; ++l) G.set(l, branches[b].shear[tet(i, l)]);
        shear_[b].push_back(G);
      }
    }
  }

  std::unique_ptr<Context> make_context() const override {
    auto start = std::make_unique<Start>();
    start->params = params_;
    start->factors.resize(times_.size());
    return start;
  }

  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    const Start& start = static_cast<Start&>(context);
    parallel_for(batch_count(), [&](int i) {
      const auto F_i = F(i, step.start);
      for (int q = 0; q < kPoints; ++q) start.params[place(i, q)].E_0 = strain(F_i, q);
    });
    begin_internal({}, step.h, context);
  }

  InternalRange internal_range() const override {
    return {first_, tet_count_, 6 * kPoints * static_cast<int>(times_.size())};
  }

  void begin_internal(std::span<const double> z, double duration, const Context& context) const override {
    const Start& start = static_cast<const Start&>(context);
    start.z = z;
    for (size_t b = 0; b < times_.size(); ++b) start.factors[b] = maxwell_factors(duration / times_[b]);
    parallel_for(batch_count(), [&](int i) {
      for (int q = 0; q < kPoints; ++q) {
        Params& p = start.params[place(i, q)];
        p.k = Pack(0.0);
        p.c = {};
        for (size_t b = 0; b < times_.size(); ++b) {
          p.k += Pack(start.factors[b].phi) * shear_[b][i];
          const Stress s = stress(z, i, q, b);
          for (int r = 0; r < 6; ++r) p.c[r] += Pack(start.factors[b].decay) * s[r];
        }
      }
    });
  }

  void end_internal(Positions x, const Context& context, std::span<double> z) const override {
    const Start& start = static_cast<const Start&>(context);
    parallel_for(batch_count(), [&](int i) {
      const auto F_i = F(i, x);
      for (int q = 0; q < kPoints; ++q) {
        const Six<Pack> change = strain_change(start, F_i, i, q);
        for (size_t b = 0; b < times_.size(); ++b) {
          const Pack decay(start.factors[b].decay), rise = Pack(2 * start.factors[b].phi) * shear_[b][i];
          Stress s = stress(start.z, i, q, b);
          for (int r = 0; r < 6; ++r) s[r] = decay * s[r] + rise * change[r];
          for (int l = 0; l < batches_[i].count; ++l)
            for (int r = 0; r < 6; ++r) z[entry(i, l, q, b) + r] = s[r][l];
        }
      }
    });
  }

  double stored_energy(std::span<const double> z) const override {
    return sum_over_branches([&](int i, int q, size_t b) { return squared(stress(z, i, q, b)) * compliance(i, b); });
  }

  InternalEnergies internal_energies(const InternalStep& step, const Context& context) const override {
    const Start& start = static_cast<const Start&>(context);
    const double work = reduce(
        [&](int i) {
          const auto after = F(i, step.end), before = F(i, step.start);
          Pack sum(0.0);
          for (int q = 0; q < kPoints; ++q)
            sum += inner(MaxwellStep::pk1(at(after, q), start.params[place(i, q)]), at(after, q) - at(before, q));
          return aspic::sum(batches_[i].volume * sum);
        },
        [](double a, double b) { return a + b; }, 0.0);
    const double loss = sum_over_branches([&](int i, int q, size_t b) {
      const MaxwellFactors& f = start.factors[b];
      const Six<Pack> change = strain_change(start, F(i, step.end), i, q);
      Stress mixed = stress(start.z, i, q, b), rise;
      for (int r = 0; r < 6; ++r) {
        rise[r] = Pack(2.0) * shear_[b][i] * change[r];
        mixed[r] += Pack(f.mixture) * rise[r];
      }
      return Pack(2.0) * compliance(i, b) * (Pack(f.loss_sum) * squared(mixed) + Pack(f.loss_rest) * squared(rise));
    });
    return {work, stored_energy(step.z_end) - stored_energy(start.z), loss};
  }

 private:
  struct Start : Context {  // data of the start of the step; see begin_internal()
    mutable std::vector<Params> params;
    mutable std::vector<MaxwellFactors> factors;  // of each branch
    mutable std::span<const double> z;
  };
  const std::vector<Params>& params(const Context& context) const override {
    return static_cast<const Start&>(context).params;
  }

  template <class Points>
  static Six<Pack> strain(const Points& F_i, int q) {
    return six_of(MaxwellStep::green_strain(at(F_i, q)));
  }
  template <class Points>
  static Six<Pack> strain_change(const Start& start, const Points& F_i, int i, int q) {
    Six<Pack> change = strain(F_i, q);
    for (int r = 0; r < 6; ++r) change[r] -= start.params[place(i, q)].E_0[r];
    return change;
  }

  Stress stress(std::span<const double> z, int batch, int q, size_t branch) const {
    Stress s = {};
    for (int l = 0; l < kPackWidth && !z.empty(); ++l)
      for (int r = 0; r < 6; ++r) s[r].set(l, z[entry(batch, l, q, branch) + r]);
    return s;
  }

  // Sums volume * of_branch over all points and branches.
  template <class OfBranch>
  double sum_over_branches(const OfBranch& of_branch) const {
    return reduce(
        [&](int i) {
          Pack sum(0.0);
          for (int q = 0; q < kPoints; ++q)
            for (size_t b = 0; b < times_.size(); ++b) sum += of_branch(i, q, b);
          return aspic::sum(batches_[i].volume * sum);
        },
        [](double a, double b) { return a + b; }, 0.0);
  }

  // Returns 1 / (4 G), or 0 where the branch is absent.
  Pack compliance(int batch, size_t branch) const {
    Pack c;
    for (int l = 0; l < kPackWidth; ++l) {
      const double G = shear_[branch][batch][l];
      c.set(l, G > 0 ? 1 / (4 * G) : 0);
    }
    return c;
  }

  // Padding lanes use the first tet.
  int tet(int batch, int lane) const {
    const Batch& tets = batches_[batch];
    return tets.tet[lane < tets.count ? lane : 0] - first_;
  }
  size_t entry(int batch, int lane, int q, size_t branch) const {
    return 6 * ((static_cast<size_t>(tet(batch, lane)) * kPoints + q) * times_.size() + branch);
  }

  int first_, tet_count_;
  std::vector<double> times_;             // relaxation time of each branch [s]
  std::vector<std::vector<Pack>> shear_;  // G of each branch and batch [Pa]
};

}  // namespace

std::unique_ptr<Energy> make_maxwell_branches(std::string name, const TetMesh& mesh, int first,
                                              std::vector<MaxwellBranch> branches) {
  ASPIC_CHECK(!branches.empty());
  if (!branches[0].shear.empty() && is_quadratic(mesh, first))
    return std::make_unique<MaxwellTerm<QuadraticTetBatch>>(std::move(name), mesh, first, std::move(branches));
  return std::make_unique<MaxwellTerm<TetBatch>>(std::move(name), mesh, first, std::move(branches));
}

}  // namespace aspic
