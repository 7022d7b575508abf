#include "aspic/progress.h"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "aspic/streams.h"

namespace aspic::cli {
namespace {

constexpr double kRedrawInterval = 0.1;  // on a terminal [s]
constexpr double kLongStep = 1;          // time of a step after which its iterations are shown on a terminal [s]
constexpr double kLineFraction = 0.05;   // fraction of the run between lines in a pipe
constexpr int kBarWidth = 20;
constexpr size_t kRecentSteps = 20;  // for the time left

// Terminals without escape sequences, such as an editor's shell, are called dumb.
bool can_redraw() {
  const char* name = std::getenv("TERM");
  return !name || std::string_view(name) != "dumb";
}

size_t terminal_width(std::FILE* stream) {  // [characters]
  winsize size{};
  const bool known = ioctl(descriptor(stream), TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return known ? size.ws_col : 80;
}

std::string step_text(const StepReport& report, int last) {
  return fmt::format("step {}/{}  t {:.4g} s  {} it  energy {:.4g} J  {}", report.step, last, report.time,
                     report.iterations, report.kinetic + report.potential_total, to_string(report.status));
}

}  // namespace

std::string duration_text(double seconds) {
  if (seconds < 9.95) return fmt::format("{:.1f} s", seconds);
  const long total = std::lround(seconds);
  if (total < 60) return fmt::format("{} s", total);
  if (total < 3600) return fmt::format("{} min {:02} s", total / 60, total % 60);
  return fmt::format("{} h {:02} min", total / 3600, total / 60 % 60);
}

StatusLine::StatusLine(std::FILE* stream, WallClock clock)
    : stream_(stream),
      terminal_(isatty(descriptor(stream)) != 0 && can_redraw()),
      clock_(std::move(clock)),
      start_(clock_()) {}

void StatusLine::draw(std::string line) {
  if (terminal_) {
    line.resize(std::min(line.size(), terminal_width(stream_) - 1));
    fmt::print(stream_, "\r{}\x1b[K", line);  // erases the rest of a longer line
    drawn_ = true;
  } else {
    fmt::print(stream_, "{}\n", line);
  }
  std::fflush(stream_);
}

void StatusLine::erase() {
  if (drawn_) fmt::print(stream_, "\r\x1b[K");
  drawn_ = false;
}

Progress::Progress(std::FILE* stream, int first_step, int last_step, WallClock clock)
    : StatusLine(stream, std::move(clock)), first_(first_step), last_(last_step), shown_step_(first_step) {}

bool Progress::is_due(const StepReport& report) const {
  if (report.step == last_) return true;
  const double waited = seconds() - shown_at_;
  if (terminal_) return waited >= kRedrawInterval;
  return waited >= kLineInterval || report.step - shown_step_ >= kLineFraction * (last_ - first_);
}

double Progress::seconds_per_step() const {
  const size_t count = std::min(ends_.size() - 1, kRecentSteps);
  return (ends_.back() - ends_[ends_.size() - 1 - count]) / static_cast<double>(count);
}

void Progress::show(const StepReport& report) {
  ends_.push_back(seconds());
  if (!is_due(report)) return;
  shown_at_ = seconds();
  shown_step_ = report.step;
  print(fmt::format("{}  {} left", step_text(report, last_), duration_text(seconds_per_step() * (last_ - report.step))),
        static_cast<double>(report.step) / last_);
}

void Progress::show(int step, const Iteration& iteration) {
  const double now = seconds();
  if (now - std::max(shown_at_, 0.0) < (terminal_ ? kLongStep : kLineInterval)) return;
  shown_at_ = now;
  print(fmt::format("step {}/{}  iteration {}  E {:.6g}  |g| {:.3g}", step, last_, iteration.index, iteration.value,
                    iteration.gradient_norm),
        static_cast<double>(step - 1) / last_);
}

void Progress::print(std::string line, double done) {
  line = fmt::format("{:3.0f}%  {}", 100 * done, line);
  if (terminal_) {
    const int filled = static_cast<int>(done * kBarWidth);
    line = fmt::format("[{:#<{}}{:.<{}}] {}", "", filled, "", kBarWidth - filled, line);
  }
  draw(std::move(line));
}

void Progress::message(const std::string& line) {
  erase();
  std::fflush(stream_);
  fmt::print(stderr, "{}\n", line);
}

void Progress::finish() {
  if (drawn_) fmt::print(stream_, "\n");
  drawn_ = false;
  std::fflush(stream_);
}

}  // namespace aspic::cli
