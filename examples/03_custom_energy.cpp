// A custom energy: an elastic floor. Every vertex below y = 0 adds
//   V = k/2 y^2,   dV/dy = k y,   d2V/dy2 = k,
// to the potential. A jelly cube falls onto it, and every step still minimizes one function.
#include <aspic/aspic.h>

#include <algorithm>
#include <cstdio>

using namespace aspic;

class Floor : public Energy {
 public:
  explicit Floor(double stiffness) : k_(stiffness) {}
  std::string_view name() const override { return "floor"; }

  double value(Positions x, const Context&) const override {
    double V = 0;
    for (size_t i = 1; i < x.size(); i += 3) V += 0.5 * k_ * depth(x[i]) * depth(x[i]);
    return V;
  }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    for (size_t i = 1; i < x.size(); i += 3) g[i] += scale * k_ * depth(x[i]);
  }
  // Vertices are not coupled to each other, so the diagonal blocks suffice.
  void bind(const BlockPattern& pattern) override { pattern_ = &pattern; }
  int add_hessian(Positions x, const Context&, double scale, const Projection&, BlockSparse& H) const override {
    for (int v = 0; v < pattern_->rows(); ++v)
      if (depth(x[3 * v + 1]) < 0) H.block[pattern_->diagonal(v)](1, 1) += scale * k_;
    return 0;  // no modified elements: the energy is convex
  }

 private:
  static double depth(double y) { return std::min(y, 0.0); }
  double k_;  // [N/m]
  const BlockPattern* pattern_ = nullptr;
};

int main() {
  const double edge = 0.1, height = 0.2;  // [m]
  Model model = ModelBuilder(make_box({0, 0, 0}, {edge, edge, edge}, {4, 4, 4}))
                    .material("neo_hookean_log", {.young = 2e4 /* [Pa] */, .poisson = 0.4})
                    .density(1000)           // [kg/m^3]
                    .gravity({0, -9.81, 0})  // [m/s^2]
                    .load(std::make_unique<Floor>(500 /* [N/m] for each vertex */))
                    .build();
  State start = at_rest(model.mesh);
  for (size_t i = 1; i < start.q.size(); i += 3) start.q[i] += height;

  Simulation simulation(std::move(model), start, {.h = 0.005, .solver = {}});
  double deepest = 0, highest_after = -1;  // lowest position so far; its height after the bounce
  for (int i = 1; i <= 160; ++i) {
    const StepReport report = simulation.step();
    if (!is_success(report.status)) return std::printf("step %d did not converge\n", i), 1;
    double lowest = 1;
    for (size_t k = 1; k < start.q.size(); k += 3) lowest = std::min(lowest, simulation.state().q[k]);
    deepest = std::min(deepest, lowest);
    if (deepest < 0) highest_after = std::max(highest_after, lowest);
    if (i % 20 == 0)
      std::printf("t = %.2f s: lowest vertex at %+.4f m, energy of the floor %.4f J\n", report.time, lowest,
                  report.potential[2]);
  }
  std::printf("it went %.1f mm into the floor and bounced %.1f cm high\n", -1e3 * deepest, 1e2 * highest_after);
  return deepest < 0 && deepest > -edge / 2 && highest_after > 0.01 ? 0 : 1;
}
