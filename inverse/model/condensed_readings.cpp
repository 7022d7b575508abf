#include "model/condensed_readings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <span>

#include "base/parallel.h"
#include "model/gauge.h"

namespace aspic {
namespace {

// Readings of a case from which on it is condensed, which changes fits by round-off only. Fewer cost little.
constexpr size_t kMany = 1000;
constexpr double kUnmeasured = 1e100;  // standard deviation of an axis without a reading: its square is finite

// Triangular factor of rows, updated row by row with Givens rotations.
class Factor {
 public:
  explicit Factor(int columns) : columns_(columns), R_(static_cast<size_t>(columns) * columns, 0.0) {}

  double at(int row, int column) const { return R_[static_cast<size_t>(row) * columns_ + column]; }

  // Overwrites the row.
  void add(std::span<double> row) {
    for (int k = 0; k < columns_; ++k) {
      if (row[k] == 0) continue;
      double* upper = &R_[static_cast<size_t>(k) * columns_];
      const double length = std::sqrt(upper[k] * upper[k] + row[k] * row[k]);
      const double c = upper[k] / length, s = row[k] / length;
      for (int j = k; j < columns_; ++j) {
        const double above = upper[j], below = row[j];
        upper[j] = c * above + s * below;
        row[j] = c * below - s * above;
      }
    }
  }

 private:
  int columns_;
  std::vector<double> R_;
};

// The readings of a case on one triangle.
struct Patch {
  std::vector<int> readings;
  bool is_isotropic = true;  // equal standard deviations along all axes

  size_t condensed_size() const { return is_isotropic ? 3 : 9; }
};

std::map<Triangle, Patch> patches_of(const Experiment& experiment, const LoadCase& load) {
  std::map<Triangle, Patch> patches;
  for (size_t i = 0; i < load.positions.size(); ++i) {
    const MarkerReading& reading = load.positions[i];
    Patch& patch = patches[experiment.markers[reading.marker].vertices];
    patch.readings.push_back(static_cast<int>(i));
    patch.is_isotropic &= reading.sigma[0] == reading.sigma[1] && reading.sigma[0] == reading.sigma[2];
  }
  return patches;
}

// Readings and markers of one case after condensation. Indices of markers count from 0. The columns of a factor are the
// weights of three corners, the common errors, and the readings, all over the standard deviation. The rows without
// weights are condensed again, over all triangles and axes.
class CondensedCase {
 public:
  CondensedCase(const Experiment& experiment, const LoadCase& load)
      : errors(load.common_errors.size()),
        experiment_(experiment),
        load_(load),
        error_count_(static_cast<int>(load.common_errors.size())),
        rest_(error_count_ + 1),
        row_(static_cast<size_t>(error_count_) + 4) {
    for (const auto& [triangle, patch] : patches_of(experiment, load))
      if (patch.readings.size() > patch.condensed_size()) {
        condense(triangle, patch);
      } else {
        for (const int i : patch.readings) keep(i);
      }
    for (int row = 0; row <= error_count_; ++row) add_row({}, 0, rest_, row, 0);
  }

  std::vector<SurfacePoint> markers;
  std::vector<MarkerReading> positions;
  std::vector<std::vector<Vec3d>> errors;  // of the positions, for each common error

 private:
  void add(const SurfacePoint& marker, MarkerReading reading) {
    reading.marker = static_cast<int>(markers.size());
    markers.push_back(marker);
    positions.push_back(reading);
    for (std::vector<Vec3d>& error : errors) error.emplace_back();
  }

  void keep(int i) {
    add(experiment_.markers[load_.positions[i].marker], load_.positions[i]);
    for (int k = 0; k < error_count_; ++k) errors[k].back() = load_.common_errors[k].markers[i];
  }

  void condense(const Triangle& triangle, const Patch& patch) {
    std::vector<Factor> factors(3, Factor(error_count_ + 4));
    for (const int i : patch.readings)
      for (int axis = 0; axis < 3; ++axis) {
        set_row(i, axis);
        factors[axis].add(row_);
      }
    for (const Factor& factor : factors)
      for (int row = 3; row < error_count_ + 4; ++row) {
        for (int j = 0; j <= error_count_; ++j) row_[j] = factor.at(row, 3 + j);
        rest_.add(std::span(row_).first(static_cast<size_t>(error_count_) + 1));
      }
    if (patch.is_isotropic) return add_common_rows(triangle, factors);
    for (int axis = 0; axis < 3; ++axis)
      for (int row = 0; row < 3; ++row) add_row(point(triangle, factors[axis], row), axis, factors[axis], row, 3);
  }

  void set_row(int i, int axis) {
    const MarkerReading& reading = load_.positions[i];
    const double precision = 1 / reading.sigma[axis];
    for (int k = 0; k < 3; ++k) row_[k] = precision * experiment_.markers[reading.marker].weights[k];
    for (int k = 0; k < error_count_; ++k) row_[3 + k] = precision * load_.common_errors[k].markers[i][axis];
    row_[3 + error_count_] = precision * reading.position[axis];
  }

  static SurfacePoint point(const Triangle& triangle, const Factor& factor, int row) {
    return {triangle, {factor.at(row, 0), factor.at(row, 1), factor.at(row, 2)}};
  }

  // The weights of all axes are equal.
  void add_common_rows(const Triangle& triangle, const std::vector<Factor>& factors) {
    for (int row = 0; row < 3; ++row) {
      add(point(triangle, factors[0], row), {0, {}, {{1, 1, 1}}});
      for (int axis = 0; axis < 3; ++axis) set_values(axis, factors[axis], row, 3);
    }
  }

  // One row of one axis.
  void add_row(const SurfacePoint& marker, int axis, const Factor& factor, int row, int first) {
    MarkerReading reading{0, {}, {{kUnmeasured, kUnmeasured, kUnmeasured}}};
    reading.sigma[axis] = 1;
    add(marker, reading);
    set_values(axis, factor, row, first);
  }

  // Common errors and reading of the last marker, from the columns from `first` on.
  void set_values(int axis, const Factor& factor, int row, int first) {
    for (int k = 0; k < error_count_; ++k) errors[k].back()[axis] = factor.at(row, first + k);
    positions.back().position[axis] = factor.at(row, first + error_count_);
  }

  const Experiment& experiment_;
  const LoadCase& load_;
  int error_count_;
  Factor rest_;
  std::vector<double> row_;
};

void replace_markers(std::vector<MarkerReading>& positions, const std::vector<SurfacePoint>& markers, Experiment& to) {
  const int first = static_cast<int>(to.markers.size());
  for (MarkerReading& reading : positions) reading.marker += first;
  to.markers.insert(to.markers.end(), markers.begin(), markers.end());
}

}  // namespace

// Estimates of systematic errors need each reading.
bool has_dense_readings(const Corrected& experiment) {
  return experiment.errors.empty() && std::any_of(experiment.cases.begin(), experiment.cases.end(),
                                                  [](const LoadCase& load) { return load.positions.size() >= kMany; });
}

Condensed condensed(const Corrected& experiment) {
  Condensed result{experiment};
  if (!has_dense_readings(experiment)) return result;
  std::vector<std::optional<CondensedCase>> cases(experiment.cases.size());
  parallel_for(static_cast<int>(cases.size()), [&](int c) { cases[c].emplace(experiment, experiment.cases[c]); });
  result.markers.clear();
  for (size_t c = 0; c < cases.size(); ++c) {
    LoadCase& load = result.cases[c];
    replace_markers(cases[c]->positions, cases[c]->markers, result);
    load.merged += measured_count(load);
    load.positions = std::move(cases[c]->positions);
    load.merged -= measured_count(load);
    for (size_t k = 0; k < load.common_errors.size(); ++k)
      load.common_errors[k].markers = std::move(cases[c]->errors[k]);
  }
  return result;
}

}  // namespace aspic
