// A cube of jelly hangs from its top face and sags under its own weight. Each step of backward Euler minimizes
//   E(x) = 1/2 (x - x~)' M (x - x~) + h^2 V(x),   x~ = q + h qdot,
// over the positions x of all vertices; V is elastic energy plus weight. The minimizer is the next q.
#include <aspic/aspic.h>

#include <cstdio>

int main() {
  constexpr double edge = 0.1;  // [m]
  aspic::Simulation simulation(aspic::ModelBuilder(aspic::make_box({0, 0, 0}, {edge, edge, edge}, {4, 4, 4}))
                                   .material("neo_hookean", {.young = 5e3 /* [Pa] */, .poisson = 0.4})
                                   .density(1000)           // [kg/m^3]
                                   .gravity({0, -9.81, 0})  // [m/s^2]
                                   .pin("top", [](const aspic::Vec3d& X) { return X[1] == edge; })
                                   .build());
  for (int i = 1; i <= 50; ++i) {  // of 0.01 s
    const aspic::StepReport report = simulation.step();
    if (!is_success(report.status)) return std::printf("step %d did not converge\n", i), 1;
    if (i % 10 == 0)
      std::printf("t = %.1f s: the corner is at y = %.4f m (%d iterations)\n", report.time, simulation.state().q[1],
                  report.iterations);
  }
  return simulation.state().q[1] < 0 ? 0 : 1;  // vertex 0 was at the origin
}
