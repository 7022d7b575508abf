#include "random_scenes/judge.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "material/registry.h"
#include "random_scenes/draw.h"
#include "results/explanation.h"

namespace aspic {
namespace {

constexpr double kRoundOff = 1e-9;     // relative to the energies that are added and the forces that balance
constexpr double kLastDigits = 1e-11;  // relative to energies that cancel in a body at rest
constexpr int kMaxPolls = 20'000;      // of the stop token, in all steps of a scene

bool is_finite(std::span<const double> v) {
  return std::all_of(v.begin(), v.end(), [](double x) { return std::isfinite(x); });
}

// For each body, whether no tet can invert: its material has an infinite barrier against inversion, and its tets are
// linear. Quadratic tets have the barrier at four inner points and at their corners, but not everywhere.
std::vector<bool> barriers(const std::string& text) {
  std::vector<bool> found;
  for (size_t at = text.find("[[body]]"); at != std::string::npos;) {
    const size_t next = text.find("[[body]]", at + 1);
    const std::string body = text.substr(at, next - at);
    const auto has = [&](const MaterialInfo& m) {
      return m.barrier && body.find("model = \"" + m.name + "\"") != std::string::npos;
    };
    const bool is_linear = body.find("order = 2") == std::string::npos;
    found.push_back(is_linear && std::any_of(materials().begin(), materials().end(), has));
    at = next;
  }
  return found;
}

class Judge {
 public:
  Judge(Scene& scene, const std::string& text)
      : scene_(scene),
        simulation_(scene.simulation),
        barriers_(barriers(text)),
        moves_(text.find("motion = {") != std::string::npos),
        total_(simulation_.kinetic_energy()) {
    for (const double V : simulation_.potential_energies()) total_ += V;
  }

  Judgment run() {
    judgment_.ending = "converged";
    int polls = 0;
    const StopToken stop([&] { return ++polls > kMaxPolls; });
    for (int i = 0; i < scene_.steps && judgment_.fault.empty(); ++i) {
      const State before = simulation_.state();
      const StepReport report = simulation_.step({}, stop);
      if (report.status == Status::interrupted) {
        judgment_.ending = "interrupted";
        break;
      }
      judge(before, report);
    }
    return judgment_;
  }

 private:
  void fault(const std::string& text, const StepReport& report) {
    if (judgment_.fault.empty())
      judgment_.fault =
          "step " + std::to_string(report.step) + ", status " + std::string(to_string(report.status)) + ": " + text;
  }

  void judge(const State& before, const StepReport& report) {
    const State& state = simulation_.state();
    if (!is_finite(state.q) || !is_finite(state.qdot)) fault("the state is not finite", report);
    if (!std::isfinite(report.ledger_error)) fault("the ledger is not finite", report);
    for (size_t body = 0; body < barriers_.size(); ++body) {
      const double det_F = simulation_.model().elasticity[body]->min_det_F(state.q);
      if (barriers_[body] && !(det_F > 0)) fault("det F = " + shortest(det_F), report);
      if (barriers_[body] && is_inside_out(body)) fault("a tet is inside out", report);
    }
    is_success(report.status) ? judge_success(report) : judge_failure(report);
    judge_ledger(report);
    if (report.energy_bound == EnergyBound::broken)
      fault("the energy bound is broken by " + shortest(-report.energy_slack) + " J", report);
    if (simulation_.options().integrator == "backward_euler") judge_descent(before, report);
  }

  // Orientation from volumes of tets, which is reliable for needles: det F of a needle of aspect ratio 10^4 has the
  // sign of its round-off.
  bool is_inside_out(size_t body) const {
    const Model& model = simulation_.model();
    TetMesh now = model.mesh;
    for (size_t i = 0; i < 3 * now.rest.size(); ++i)
      now.rest[i / 3][static_cast<int>(i % 3)] = simulation_.state().q[i];
    const double noise = kRoundOff * std::max(1.0, distance());
    const double eps = std::numeric_limits<double>::epsilon();
    const int first = model.bodies[body].first_tet, end = first + model.bodies[body].tet_count;
    for (int t = first; t < end; ++t) {
      const double stretch = std::sqrt(squared_norm(edge_matrix(now, t) * inverse(edge_matrix(model.mesh, t))));
      if (volume(now, t) < -(noise + eps * stretch * stretch * stretch) * volume(model.mesh, t)) return true;
    }
    return false;
  }

  void judge_success(const StepReport& report) {
    if (!std::isfinite(report.kinetic) || !std::isfinite(report.potential_total))
      fault("the energy is not finite", report);
    const bool is_above = report.residual_threshold > 0 && report.residual > report.residual_threshold;
    if (report.status == Status::converged && is_above)
      fault("residual " + shortest(report.residual) + " N, threshold " + shortest(report.residual_threshold) +
                " N, round-off " + shortest(report.residual_round_off) + " N",
            report);
  }

  void judge_failure(const StepReport& report) {
    const Explanation why = explain(simulation_, report);
    if (why.cause.empty() || why.remedy.empty()) fault("no explanation", report);
    if (judgment_.ending != "converged") return;
    judgment_.ending = to_string(report.status);
    judgment_.detail = why.cause + " | " + why.place + " | " + why.remedy;
  }

  // Checks that the report's energies are those of the state and that their changes add up.
  void judge_ledger(const StepReport& report) {
    double potential = 0, size = std::abs(report.kinetic);
    for (const double V : simulation_.potential_energies()) potential += V, size += std::abs(V);
    const double kinetic = simulation_.kinetic_energy();
    for (const double w : {report.pin_work, report.nonconservative_work, report.damping_loss, report.numerical_loss,
                           report.residual_work, size_})
      size += std::abs(w);
    const double open = std::abs(kinetic - report.kinetic) + std::abs(potential - report.potential_total) +
                        std::abs(report.ledger_error);
    if (!(open <= kRoundOff * size * std::max(1.0, 1e-6 * distance())))
      fault("the ledger is open by " + shortest(open) + " of " + shortest(size), report);
    size_ = std::abs(kinetic);
    for (const double V : report.potential) size_ += std::abs(V);
  }

  // Distance of the body from the origin in sizes of its rest shape; the round-off of strains is proportional to it.
  double distance() const {
    double far = 0, low = INFINITY, high = -INFINITY;
    for (const double q : simulation_.state().q) far = std::max(far, std::abs(q));
    for (const Vec3d& X : simulation_.model().mesh.rest) low = std::min(low, X[0]), high = std::max(high, X[0]);
    return far / (high - low);
  }

  // Sum of Young's modulus times volume: scale of the round-off of energies. [J]
  double stiffness() const {
    const Model& model = simulation_.model();
    double sum = 0;
    for (int t = 0; t < model.mesh.tet_count(); ++t) sum += model.tet_fields[0].second[t] * volume(model.mesh, t);
    return sum;
  }

  // Backward Euler: V1 + |v1 - v0|^2 / 2 <= V0 + T0 for any status, provided that nothing is moved.
  void judge_descent(const State& before, const StepReport& report) {
    const SimulationOptions& options = simulation_.options();
    const bool descends = options.solver.minimize.line_search.test != DecreaseTest::none &&
                          (options.initial_guess == "best" || options.initial_guess == "current") &&
                          options.adaptive.tolerance == 0 && simulation_.model().damping.empty();
    const double total = report.kinetic + report.potential_total;
    const double earlier = std::exchange(total_, total);
    if (!descends || moves_ || report.status == Status::undefined) return;
    std::vector<double> change(before.qdot.size()), momentum(before.qdot.size());
    for (size_t i = 0; i < change.size(); ++i) change[i] = simulation_.state().qdot[i] - before.qdot[i];
    simulation_.model().mass->multiply(change, momentum);
    double lost = 0;
    for (size_t i = 0; i < change.size(); ++i) lost += 0.5 * change[i] * momentum[i];
    const double rise = report.potential_total + lost - earlier;
    if (!(rise <= kRoundOff * (size_ + std::abs(lost) + std::abs(earlier)) + kLastDigits * stiffness()))
      fault("the energy rises by " + shortest(rise) + " from " + shortest(earlier), report);
  }

  Scene& scene_;
  Simulation& simulation_;
  std::vector<bool> barriers_;  // per body
  bool moves_;                  // pins or spring targets move
  double size_ = 0;             // sum of the magnitudes of the report's energies
  double total_;                // energy before the step
  Judgment judgment_;
};

}  // namespace

Judgment judge(Scene& scene, const std::string& text) { return Judge(scene, text).run(); }

}  // namespace aspic
