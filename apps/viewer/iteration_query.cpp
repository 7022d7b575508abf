#include "viewer/replies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "viewer/commands.h"

namespace aspic::viewer {
namespace {

constexpr size_t kMaxOfPath = 1000;                       // maximum number of iterates of a path
constexpr size_t kMaxPathBytes = size_t{128} << 20;       // maximum memory of iterates before the plane is known
constexpr double kTetsOfSlice = 2e7, kTetsOfCurve = 1e7;  // evaluations of tets: 0.5 s of CPU time together

int slice_samples(int tets) {
  const int samples = static_cast<int>(std::sqrt(kTetsOfSlice / std::max(tets, 1)));
  return std::clamp(samples | 1, 9, 41);  // odd, so that one sample is the iterate
}

int curve_samples(int tets) { return std::clamp(static_cast<int>(kTetsOfCurve / std::max(tets, 1)), 31, 101); }

double scalar_product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Observes a repeated step and samples E around one of its iterations. A step of several stages has several
// minimizations: the count of iterations includes all of them, the path only the one with that iteration.
class ObservedIteration {
 public:
  ObservedIteration(int iteration, double sufficient_decrease, int tets, const StopToken& stop)
      : iteration_(iteration), sufficient_decrease_(sufficient_decrease), tets_(tets), stop_(stop) {}

  void follow(const LiveIteration& live);
  bool is_met() const { return !x_.empty(); }
  int iterations() const { return count_; }  // number up to now
  Json reply() &&;

 private:
  struct Iterate {
    std::vector<double> x;
    double value = 0;
  };

  void take(const LiveIteration& live);
  Json on_plane(std::span<const double> x, double value) const;

  const int iteration_;
  const double sufficient_decrease_;
  const int tets_;
  const StopToken& stop_;

  int count_ = 0;
  std::vector<Iterate> before_;  // iterates of this minimization, until the plane is known
  bool is_of_path_ = true;       // false: a later minimization has started
  double value_ = 0, alpha_ = 0, max_step_ = 0;
  std::vector<Trial> tried_;
  std::vector<CurvePoint> curve_;
  Slice slice_;
  std::vector<double> x_, d_;
  Json path_ = Json::array(), end_;
};

void ObservedIteration::follow(const LiveIteration& live) {
  const bool is_requested = count_++ == iteration_;
  if (live.index == 0) {
    if (is_met()) is_of_path_ = false;
    before_.clear();
  }
  if (is_requested) {
    take(live);
    for (const Iterate& iterate : before_) path_.push_back(on_plane(iterate.x, iterate.value));
    before_.clear();
  }
  if (!is_met()) {
    if (before_.size() < std::min(kMaxOfPath, kMaxPathBytes / live.x.size_bytes()))
      before_.push_back({{live.x.begin(), live.x.end()}, live.value});
  } else if (is_of_path_ && path_.size() < kMaxOfPath) {
    path_.push_back(on_plane(live.x, live.value));
    end_ = on_plane(live.x_next, std::numeric_limits<double>::quiet_NaN());
  }
}

void ObservedIteration::take(const LiveIteration& live) {
  value_ = live.value;
  alpha_ = live.alpha;
  tried_.assign(live.tried.begin(), live.tried.end());
  x_.assign(live.x.begin(), live.x.end());
  d_.assign(live.d.begin(), live.d.end());
  curve_ = curve_along(live, sufficient_decrease_, curve_samples(tets_), stop_);
  max_step_ = curve_.empty() ? 0 : largest_step(live, curve_.back().alpha);
  slice_ = slice_through(live, slice_samples(tets_), stop_);
}

Json ObservedIteration::on_plane(std::span<const double> x, double value) const {
  if (slice_.across.empty()) return nullptr;  // no plane
  std::vector<double> away(x.begin(), x.end());
  for (size_t i = 0; i < away.size(); ++i) away[i] -= x_[i];
  const auto along = [&](const std::vector<double>& u) {
    const double uu = scalar_product(u, u);
    return uu > 0 ? scalar_product(away, u) / uu : 0;
  };
  return {{"s", along(d_)}, {"t", along(slice_.across)}, {"value", value}};
}

// Returns one member of all points.
template <class Point>
Json column(const std::vector<Point>& points, double Point::*member) {
  Json list = Json::array();
  for (const Point& point : points) list.push_back(point.*member);
  return list;
}

Json slice_json(const Slice& slice) {
  Json s = Json::array(), t = Json::array();
  for (int i = 0; i < slice.columns; ++i) s.push_back(slice.point[i].s);
  for (int row = 0; row < slice.rows; ++row) t.push_back(slice.point[static_cast<size_t>(row) * slice.columns].t);
  Json blocked = Json::array();
  for (size_t i = 0; i < slice.point.size(); ++i)
    if (slice.point[i].is_blocked) blocked.push_back(i);
  return {{"columns", slice.columns},
          {"rows", slice.rows},
          {"s", s},
          {"t", t},
          {"value", column(slice.point, &SlicePoint::value)},
          {"model", column(slice.point, &SlicePoint::model)},
          {"blocked", blocked}};
}

Json ObservedIteration::reply() && {
  path_.push_back(std::move(end_));
  return {{"value", value_},
          {"alpha", alpha_},
          {"trials", viewer::to_json(tried_)},
          {"max_step", max_step_},
          {"curve", viewer::to_json(curve_)},
          {"slice", slice_json(slice_)},
          {"path", std::move(path_)}};
}

std::string describe(const StepReport& report, const StepRow* row) {
  std::string text = fmt::format("{} after {} iterations", to_string(report.status), report.iterations);
  if (row && !row->why.cause.empty()) text += fmt::format(": {}; {}", row->why.cause, row->why.remedy);
  return text;
}

}  // namespace

Json to_json(const std::vector<CurvePoint>& curve) {
  return {{"alpha", column(curve, &CurvePoint::alpha)},
          {"value", column(curve, &CurvePoint::value)},
          {"model", column(curve, &CurvePoint::model)},
          {"textbook", column(curve, &CurvePoint::textbook_bound)},
          {"slide", column(curve, &CurvePoint::slide_bound)}};
}

Json iteration_reply(Side& side, int step, int iteration, const StopToken& stop) {
  const double c = side.simulation().options().solver.minimize.line_search.sufficient_decrease;
  ObservedIteration observed(iteration, c, side.model().mesh.tet_count(), stop);
  const StepReport report = side.repeat(
      step, [&](const LiveIteration& live) { observed.follow(live); }, stop);
  if (stop.stopped()) throw Interrupted("interrupted by a command; repeat the question");
  if (!observed.is_met())
    throw InvalidInput(observed.iterations() == 0 ? fmt::format("step {} minimizes nothing", step)
                                                  : fmt::format("iteration {}: step {} has iterations 0 to {}",
                                                                iteration, step, observed.iterations() - 1));
  Json reply = std::move(observed).reply();
  reply["step"] = step;
  reply["iteration"] = iteration;
  reply["text"] = describe(report, side.history().rows().find(step));
  return reply;
}

}  // namespace aspic::viewer
