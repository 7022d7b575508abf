#include "dynamics/pins.h"

#include <algorithm>

#include "base/check.h"
#include "base/parallel.h"

namespace aspic {

Pins::Pins(const std::vector<Pin>& pins, std::span<const double> start)
    : pins_(&pins), start_(start.begin(), start.end()), pinned_(start.size() / 3, 0) {
  for (const Pin& pin : pins)
    for (const int v : pin.vertices) {
      ASPIC_CHECK(!pinned_[v]);
      pinned_[v] = 1;
    }
}

bool Pins::any_moves() const {
  return std::any_of(pins_->begin(), pins_->end(), [](const Pin& pin) { return pin.motion != nullptr; });
}

void Pins::place(double time, std::span<double> x) const {
  for (const Pin& pin : *pins_)
    for (const int v : pin.vertices) {
      const Vec3d start{{start_[3 * v], start_[3 * v + 1], start_[3 * v + 2]}};
      const Vec3d position = pin.motion ? pin.motion(start, time) : start;
      for (int r = 0; r < 3; ++r) x[3 * v + r] = position[r];
    }
}

void Pins::set_zero(std::span<double> v) const {
  for (size_t i = 0; i < pinned_.size(); ++i)
    if (pinned_[i]) v[3 * i] = v[3 * i + 1] = v[3 * i + 2] = 0;
}

void Pins::set_identity(BlockSparse& H) const {
  const BlockPattern& pattern = *H.pattern;
  parallel_chunks(pattern.rows(), [&](int first, int last) {
    for (int i = first; i < last; ++i)
      for (int64_t k = pattern.row_start[i]; k < pattern.row_start[i + 1]; ++k)
        if (pinned_[i] || pinned_[pattern.column[k]]) H.block[k] = {};
    for (int i = first; i < last; ++i)
      if (pinned_[i]) H.block[pattern.diagonal(i)] = identity3<double>();
  });
}

}  // namespace aspic
