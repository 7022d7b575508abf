// A custom material defined by its energy density. Automatic differentiation provides stress and Hessian.
//
// Soft tissue stiffens exponentially when stretched [Demiray 1972]:
//   psi = mu / (2 b) (exp(b (I1 - 3 - 2 ln J)) - 1) + lambda / 2 (ln J)^2,   I1 = tr(F'F), J = det F.
// A bar of it is stretched to 1.6 times its length, and its force increases progressively.
#include <aspic/aspic.h>
#include <aspic/custom_material.h>

#include <cstdio>

using namespace aspic;

struct TissueEnergy {
  template <class T>
  struct Params {
    T mu, lambda;  // [Pa]
    T b;           // [1]
  };

  template <class T>  // double, SIMD lanes or derivatives
  static T psi(const Mat3<T>& F, const Params<T>& p) {
    const T J = determinant(F), log_J = log(J);
    const T growth = exp(p.b * (squared_norm(F) - T(3.0) - T(2.0) * log_J)) - T(1.0);
    return infinite_unless_positive(J, T(0.5) * p.mu / p.b * growth + T(0.5) * p.lambda * log_J * log_J);
  }

  template <class T>  // from small-strain constants and up to three additional numbers
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, m.lame.lambda, m.extra[0]};
  }
};
using Tissue = FromEnergy<TissueEnergy>;

int main() {
  constexpr double length = 0.1, width = 0.02;     // [m]
  constexpr double pull = 0.06, seconds = 1;       // displacement of the end [m], duration [s]
  const MaterialParameters skin{{2e4, 8e4}, {3}};  // uniform here; may vary from tet to tet
  Model model = ModelBuilder(make_box({0, 0, 0}, {length, width, width}, {10, 2, 2}))
                    .material(custom_material<Tissue>("tissue", 1), skin)
                    .density(1000)  // [kg/m^3]
                    .pin("fixed", [](const Vec3d& X) { return X[0] == 0; })
                    .pin(
                        "pulled", [](const Vec3d& X) { return X[0] == length; },
                        [](const Vec3d& X, double t) {
                          return X + Vec3d{{pull * t / seconds, 0, 0}};
                        })
                    .build();

  // Each step of a quasi-static pull minimizes V itself.
  Simulation simulation(std::move(model), {.h = 0.05, .integrator = "quasi_static", .solver = {}});
  double first_force = 0, force = 0, before = 0;  // [N]
  for (int i = 1; i <= 20; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) {
      std::printf("step %d did not converge\n", i);
      return 1;
    }
    before = force;
    force = report.pin_work / (pull * 0.05 / seconds);  // work of the end divided by its displacement
    if (i == 1) first_force = force;
    if (i % 5 == 0) std::printf("stretch %.2f: %.2f N\n", 1 + pull * report.time / seconds / length, force);
  }
  std::printf("the last step adds %.1f times as much force as the first\n", (force - before) / first_force);
  return force - before > 3 * first_force ? 0 : 1;  // neo-Hookean materials soften instead
}
