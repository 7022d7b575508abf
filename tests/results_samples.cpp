// Writes a small file of each result format into the folder given by the only argument, for results_oracle.py.
#include <cstdio>
#include <filesystem>

#include "base/error.h"
#include "io/pc2.h"
#include "io/usd.h"
#include "io/vtu.h"

namespace {

using namespace aspic;

// Point i of sample s is at (i + s, i / 3, -s / 7).
std::vector<double> sample_points(int sample) {
  std::vector<double> x;
  for (int i = 0; i < 5; ++i) x.insert(x.end(), {double(i + sample), i / 3.0, -sample / 7.0});
  return x;
}

void write_samples(const std::filesystem::path& folder) {
  const std::vector<Tet> tets = {{0, 1, 2, 3}, {1, 2, 3, 4}};
  const std::vector<Triangle> triangles = {{0, 2, 1}, {2, 3, 4}};
  const Field velocity{"velocity", 3, sample_points(1)};
  const Field stress{"cauchy", 6, {1, 2, 3, 4, 5, 6, -1, -2, -3, -4, -5, 0.1}, FieldType::float32};
  const Field body{"body", 1, {0, 1}, FieldType::int32};
  std::vector<std::pair<double, std::string>> frames;
  Pc2File cache = Pc2File::create(folder / "skin.pc2", 5);
  for (int sample = 0; sample < 3; ++sample) {
    const std::string name = "body_" + std::to_string(sample) + ".vtu";
    write_vtu(folder / name, sample_points(sample), tets, {{velocity}, {stress, body}});
    frames.emplace_back(0.1 * sample, name);
    cache.append(sample_points(sample));
  }
  write_pvd(folder / "run.pvd", frames);
  const auto points = [&](int sample) { return cache.sample(sample); };
  const std::vector<TriangleUv> uv = {{{{0, 0}, {1, 0}, {0.5F, 1}}}, {{{0.25F, 0}, {-1, 2}, {0, 0}}}};
  UsdMesh skin{"skin", triangles, points};
  skin.uv = uv;
  write_usd(folder / "run.usda", {skin, {"soft bar", triangles, points}}, {0, 0.1, 0.2}, 10);

  // Long enough for several compressed blocks.
  std::vector<double> many;
  std::vector<Tet> chain;
  for (int i = 0; i < 40000; ++i) many.insert(many.end(), {i * 0.1, i * 0.01, 1.0 / (i + 1)});
  for (int i = 0; i + 3 < 40000; ++i) chain.push_back({i, i + 1, i + 2, i + 3});
  write_vtu(folder / "large.vtu", many, chain);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  try {
    std::filesystem::create_directories(argv[1]);
    write_samples(argv[1]);
  } catch (const aspic::InvalidInput& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
