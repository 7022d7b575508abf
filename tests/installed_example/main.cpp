// The smallest program outside the source tree that uses the installed library.
#include <cmath>
#include <cstdio>

#include "material/registry.h"
#include "mesh/generators.h"

int main() {
  const aspic::TetMesh box = aspic::make_box({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
  double total = 0;
  for (int t = 0; t < box.tet_count(); ++t) total += aspic::volume(box, t);
  std::printf("%d tets, %g m^3, %zu materials\n", box.tet_count(), total, aspic::materials().size());
  return std::abs(total - 1) < 1e-12 && !aspic::materials().empty() ? 0 : 1;
}
