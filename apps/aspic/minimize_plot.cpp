// Pictures of a minimization in the plane.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "aspic/minimize.h"
#include "aspic/plot.h"
#include "base/error.h"
#include "optimize/hessian_policy.h"

namespace aspic::cli {
namespace {

constexpr size_t kRejectedShown = 100;  // limit per path; thousands would hide the path

struct Region {
  Planar lower, upper;
  void include(const Planar& p) {
    for (size_t i = 0; i < 2; ++i) lower[i] = std::min(lower[i], p[i]), upper[i] = std::max(upper[i], p[i]);
  }
};

// Region of the problem, or around the path; extended within limits if the path leaves it.
Region region(const Problem& problem, std::span<const Minimization> methods) {
  Region all{problem.start, problem.start};
  if (problem.region) all = {problem.region->first, problem.region->second};
  const Region core = all;
  const double size = problem.region ? std::max(core.upper[0] - core.lower[0], core.upper[1] - core.lower[1]) : 10;
  const auto include = [&](const Planar& p) {
    const bool near = p[0] > core.lower[0] - size && p[0] < core.upper[0] + size && p[1] > core.lower[1] - size &&
                      p[1] < core.upper[1] + size;
    if (near) all.include(p);
  };
  for (const Minimization& done : methods)
    for (const IterationRecord& record : done.iterations) include(record.next);
  include(problem.start);
  if (problem.region) return all;
  for (size_t i = 0; i < 2; ++i) {
    const double margin = 0.25 * (all.upper[i] - all.lower[i]) + 0.5;
    all.lower[i] -= margin;
    all.upper[i] += margin;
  }
  return all;
}

std::string name_in_picture(const Minimization& done) {
  std::string name = done.method;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

template <class F>
SampledFunction sampled(const Region& region, int samples, F f) {
  SampledFunction grid;
  const auto coordinate = [&](size_t axis, int k) {
    return region.lower[axis] + (region.upper[axis] - region.lower[axis]) * k / (samples - 1);
  };
  for (int k = 0; k < samples; ++k) grid.x.push_back(coordinate(0, k)), grid.y.push_back(coordinate(1, k));
  for (const double y : grid.y)
    for (const double x : grid.x) grid.z.push_back(f(Planar{x, y}));
  return grid;
}

Planar along(const IterationRecord& record, double alpha) {
  return {record.x[0] + alpha * record.direction[0], record.x[1] + alpha * record.direction[1]};
}

Definiteness projection(const Minimization& done, const IterationRecord& record) {
  if (done.definiteness == NewtonDefiniteness::absolute) return Definiteness::absolute;
  const bool clamped = done.definiteness == NewtonDefiniteness::clamped || record.iteration.direction.projected;
  return clamped ? Definiteness::clamped : Definiteness::exact;
}

// Square around x and x + d that shows both and the segment between them.
Region neighborhood(const IterationRecord& record, const Region& whole) {
  const double size = std::max(whole.upper[0] - whole.lower[0], whole.upper[1] - whole.lower[1]);
  const double reach = std::hypot(record.direction[0], record.direction[1]);
  const double half = std::clamp(1.6 * reach, 0.1 * size, 0.5 * size);
  const Planar middle = along(record, std::min(0.5, half / (2 * std::max(reach, 1e-300))));
  return {{middle[0] - half, middle[1] - half}, {middle[0] + half, middle[1] + half}};
}

}  // namespace

void draw_paths(const std::filesystem::path& path, const std::string& title, const Problem& problem,
                const std::vector<Minimization>& methods) {
  const PlanarFunction& f = *problem.function;
  ContourMap map{.title = title,
                 .function = sampled(region(problem, methods), 241, [&](const Planar& p) { return f.at(p); }),
                 .paths = {},
                 .minimizer = problem.minimizer};
  for (const Minimization& done : methods) {
    const char* end = is_success(done.report.status) ? "" : ", not converged";
    PlanarPath line{.label = fmt::format("{}, {} iterations{}", name_in_picture(done), done.report.iterations, end),
                    .points = {problem.start}};
    for (const IterationRecord& record : done.iterations) {
      line.points.push_back(record.next);
      for (const Trial& trial : record.tried)
        if (!trial.accepted && line.rejected.size() < kRejectedShown)
          line.rejected.push_back(along(record, trial.alpha));
    }
    map.paths.push_back(std::move(line));
  }
  draw(path, map);
}

void draw_model(const std::filesystem::path& path, const Problem& problem, const Minimization& done, int iteration) {
  const PlanarFunction& f = *problem.function;
  const auto count = static_cast<int>(done.iterations.size());
  if (iteration >= count)
    throw InvalidInput(fmt::format("--iteration {}: only {} iterations (counted from 0)", iteration, count));
  const IterationRecord& record = done.iterations[static_cast<size_t>(iteration)];
  const QuadraticModel model = f.model(record.x, projection(done, record));
  const Planar target = along(record, 1);
  const Region box = neighborhood(record, region(problem, {&done, 1}));
  SurfacePlot plot{.title = fmt::format("{}, iteration {}: f = {}", name_in_picture(done), iteration, problem.formula),
                   .z_label = "f",
                   .function = sampled(box, 45, [&](const Planar& p) { return f.at(p); }),
                   .model = sampled(box, 45, [&](const Planar& p) { return model.at(p); }),
                   .model_label = "quadratic model"};
  double low = INFINITY, high = -INFINITY;
  for (const double z : plot.function.z)
    if (std::isfinite(z)) low = std::min(low, z), high = std::max(high, z);
  plot.z_min = std::min(low, std::max(model.at(target), low - (high - low))) - 0.05 * (high - low);
  plot.z_max = high;
  plot.points = {{"x", record.x[0], record.x[1], model.value},
                 {"x + d on the model", target[0], target[1], model.at(target)},
                 {"f(x + d)", target[0], target[1], f.at(target)},
                 {"accepted", record.next[0], record.next[1], f.at(record.next)}};
  std::erase_if(plot.points, [&](const MarkedPoint& p) {  // far away, possibly on a plateau
    return p.x < box.lower[0] || p.x > box.upper[0] || p.y < box.lower[1] || p.y > box.upper[1];
  });
  draw(path, plot);
}

}  // namespace aspic::cli
