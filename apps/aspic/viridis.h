// Colours for values.
#pragma once
#include <algorithm>
#include <array>
#include <cstddef>

namespace aspic::cli {

using Color = std::array<double, 3>;  // red, green, blue in [0, 1]

// matplotlib's viridis: even in lightness, told apart by all eyes.
inline constexpr Color kViridis[] = {{0.267, 0.005, 0.329}, {0.283, 0.141, 0.458}, {0.254, 0.265, 0.530},
                                     {0.207, 0.372, 0.553}, {0.164, 0.471, 0.558}, {0.128, 0.567, 0.551},
                                     {0.135, 0.659, 0.518}, {0.267, 0.749, 0.441}, {0.478, 0.821, 0.318},
                                     {0.741, 0.873, 0.150}, {0.993, 0.906, 0.144}};

inline Color viridis(double t) {
  const double at = std::clamp(t, 0.0, 1.0) * (std::size(kViridis) - 1);
  const size_t i = std::min(static_cast<size_t>(at), std::size(kViridis) - 2);
  const double s = at - static_cast<double>(i);
  Color c;
  for (size_t k = 0; k < 3; ++k) c[k] = (1 - s) * kViridis[i][k] + s * kViridis[i + 1][k];
  return c;
}

}  // namespace aspic::cli
