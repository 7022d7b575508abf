// A custom search direction, the open slot "d = ?" of the loop. Gradient descent with momentum (the heavy ball [Polyak
// 1964]) adds the previous direction,
//   d = -g + beta d_before,
// and needs far fewer iterations than d = -g in the curved valley of Rosenbrock's function.
#include <aspic/optimize.h>

#include <cstdio>

using namespace aspic;

class HeavyBall : public SearchDirection {
 public:
  explicit HeavyBall(double beta) : beta_(beta) {}
  std::string_view name() const override { return "heavy_ball"; }

  void begin() override { before_.clear(); }  // a new minimization starts without momentum

  bool compute(const Iterate& at, std::span<double> d, DirectionReport&) override {
    before_.resize(d.size());
    for (size_t i = 0; i < d.size(); ++i) d[i] = -at.g[i] + beta_ * before_[i];
    if (!(at.E.dot(at.g, d) < 0))  // not a descent direction: drop the momentum
      for (size_t i = 0; i < d.size(); ++i) d[i] = -at.g[i];
    before_.assign(d.begin(), d.end());
    return true;
  }
  // The line search found no step along d: drop the momentum once, then fail.
  bool fall_back() override {
    const bool had_momentum = !before_.empty();
    before_.clear();
    return had_momentum;
  }

 private:
  double beta_;
  std::vector<double> before_;  // the last direction
};

int iterations(SearchDirection& direction) {
  Rosenbrock f;
  std::vector<double> x = {-0.8, 0.6, 0};  // the third entry is padding
  MinimizeOptions options;
  options.max_iterations = 100000;
  options.tolerance = 1e-4;
  const MinimizeReport report = Minimizer().minimize(f, direction, x, options);
  std::printf("%-16s %s at (%.4f, %.4f) after %d iterations and %d evaluations of f\n",
              std::string(direction.name()).c_str(), std::string(to_string(report.status)).c_str(), x[0], x[1],
              report.iterations, report.values);
  return is_success(report.status) ? report.iterations : -1;
}

int main() {
  const auto plain = make_search_direction({.method = "gradient_descent"});
  HeavyBall ball(0.8);
  const int without = iterations(*plain), with = iterations(ball);
  return with > 0 && with < without / 2 ? 0 : 1;
}
