// Decides when a minimization updates lagged coefficients, such as the normal forces in friction.
#pragma once
#include <algorithm>
#include <limits>
#include <optional>

#include "optimize/minimize.h"

namespace aspic {

// The minimizer is that of E with the coefficients evaluated there. Before, coefficients are updated at the first
// iterate and where the forces have fallen below those after the last update, but after many updates only at
// minimizers: near the end, forces that come from one Newton step keep the updates from settling.
class LagUpdates {
 public:
  using End = std::optional<Status>;  // empty: the minimization continues

  // E: null if the coefficients are constant.
  void begin(HasLag* E) {
    *this = {};
    E_ = E;
    is_current_ = !E;
  }
  void note_step() { is_current_ = !E_; }
  bool is_current() const { return is_current_; }  // whether the coefficients are those at x

  // Returns whether to update at x, where the minimization would continue or end otherwise.
  bool is_due(const MinimizeReport& report, End end) const {
    if (is_current_) return false;
    return end ? is_success(*end)
               : counted_ <= kEarly && report.reached <= std::max(kProgress * changed_, report.threshold);
  }
  void update(std::span<const double> x) {
    E_->update_lagged(x, ++counted_ > kTurning);
    is_current_ = true;
  }
  // Returns how the minimization ends after an update. before, after: its ends without and with the update.
  End end_after(const MinimizeReport& report, double round_off, End before, End after) {
    is_reduced_ = report.reached < kProgress * changed_;
    if (!is_reduced_) counted_ += kWithoutProgress;
    changed_ = report.reached;
    if (after) return after;
    if (report.updates == kMaxUpdates) return Status::inaccurate;
    if (!before) return {};
    stalled_ = report.reached < kProgress * least_ ? 0 : stalled_ + 1;
    least_ = std::min(least_, report.reached);
    const bool is_noise = *before == Status::round_off && report.reached <= kNoise * round_off;
    return is_noise && stalled_ >= kStalled ? End(Status::round_off) : std::nullopt;
  }
  // Scales an update if updates alternate or repeat: at a minimizer, after many updates, or one that did not reduce the
  // forces. Returns whether it did.
  bool relax(bool is_minimizer) {
    const bool is_early = !is_minimizer && is_reduced_ && counted_ <= kTurning;
    if (is_early || !E_->relax_lagged()) return false;
    is_current_ = false;
    return true;
  }

 private:
  // Updates with all directions. Normals rotate within a small gap around an edge, and updates would alternate.
  static constexpr int kTurning = 12;
  static constexpr int kEarly = 24;           // updates before those at minimizers alone
  static constexpr int kWithoutProgress = 2;  // added to the count for one that did not reduce the forces
  static constexpr double kProgress = 0.9;    // factor of the forces that counts as progress
  static constexpr double kNoise = 100;       // forces below this multiple of their rounding error are noise
  static constexpr int kStalled = 3;          // updates that end in noise before the minimization ends there

  HasLag* E_ = nullptr;
  bool is_current_ = true;
  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  double least_ = kInfinity;
  double changed_ = kInfinity;  // forces after the last update
  bool is_reduced_ = true;      // whether the last update reduced the forces
  int counted_ = 0;             // updates, and kWithoutProgress for each that did not reduce the forces
  int stalled_ = 0;
};

}  // namespace aspic
