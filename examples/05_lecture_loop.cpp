// The lecture's loop written out: for each time step, minimize
//   E(q) = 1/2 (q - q~)' M (q - q~) + h^2 V(q),   q~ = q + h qdot,
// by Newton's method with backtracking line search. `Simulation` does the same with more safeguards; both must agree.
#include <aspic/aspic.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <numeric>

using namespace aspic;
using Vector = std::vector<double>;

Model hanging_bar(int n) {
  return ModelBuilder(make_box({0, 0, 0}, {0.4, 0.1, 0.1}, {4 * n, n, n}))
      .material("neo_hookean", {.young = 1e5 /* [Pa] */, .poisson = 0.4})
      .density(1000)           // [kg/m^3]
      .gravity({0, -9.81, 0})  // [m/s^2]
      .pin("wall", [](const Vec3d& X) { return X[0] == 0; })
      .build();
}

double norm(const Vector& v) { return std::sqrt(std::inner_product(v.begin(), v.end(), v.begin(), 0.0)); }

// An argument is the number of cells along the short edges.
int main(int count, char** arguments) {
  const int n = count > 1 ? std::atoi(arguments[1]) : 2;
  const double h = 0.01;  // [s]
  Model model = hanging_bar(n);
  const State start = at_rest(model.mesh);

  const Pins pins(model.pins, start.q);
  IncrementalPotential E(model, pins);
  const auto solver = make_linear_solver("cholesky");
  solver->analyze(E.pattern());

  Vector q = start.q, qdot = start.qdot, predicted = q, g(q.size()), d(q.size()), trial(q.size());
  const std::clock_t begin = std::clock();
  for (int step = 1; step <= 20; ++step) {
    const Vector before = q;
    for (size_t i = 0; i < q.size(); ++i) predicted[i] = q[i] + h * qdot[i];
    E.at({.predicted = predicted, .inertia = 1, .factor = h * h});

    int iteration = 0;  // initial guess: q
    for (E.gradient(q, g); norm(g) > 1e-10; E.gradient(q, g), ++iteration) {
      if (iteration == 50) return std::printf("step %d did not converge\n", step), 1;
      if (!solver->factorize(E.hessian(q, {Definiteness::clamped}))) return 1;
      solver->solve(g, d, 0);  // H d = g, then d = -d
      double slope = 0;
      for (size_t i = 0; i < d.size(); ++i) slope -= g[i] * d[i];
      const Evaluation at_q = E.evaluate(q);
      for (double alpha = 1;; alpha *= 0.5) {
        for (size_t i = 0; i < q.size(); ++i) trial[i] = q[i] - alpha * d[i];
        if (E.value(trial) <= at_q.value + at_q.round_off + 1e-4 * alpha * slope || alpha < 1e-10) break;
      }
      q = trial;
    }
    for (size_t i = 0; i < q.size(); ++i) qdot[i] = (q[i] - before[i]) / h;
    if (step % 5 == 0)
      std::printf("t = %.2f s: the tip is at y = %.6f m (%d iterations)\n", step * h, q.end()[-2], iteration);
  }
  std::printf("%.3f s of CPU time\n", double(std::clock() - begin) / CLOCKS_PER_SEC);

  Simulation simulation(hanging_bar(n), {.h = h, .solver = {}});
  for (int step = 0; step < 20; ++step) simulation.step();
  double difference = 0;
  for (size_t i = 0; i < q.size(); ++i) difference = std::max(difference, std::abs(q[i] - simulation.state().q[i]));
  std::printf("Simulation differs by at most %.1e m\n", difference);
  return difference < 1e-6 ? 0 : 1;
}
