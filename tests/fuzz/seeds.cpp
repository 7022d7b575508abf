// Writes the seeds of all targets, each small, to FOLDER/corpus and the generated dictionaries to FOLDER/dictionaries.
// Meshes come from the library's writers and from examples of its tests.
#include <cstdio>
#include <filesystem>

#include "io/atomic_file.h"
#include "seeds.h"

namespace aspic::fuzz {

void write_seeds(const std::filesystem::path& folder, const std::vector<Seed>& seeds) {
  for (const Seed& seed : seeds) {
    std::filesystem::create_directories(folder / seed.target);
    write_file(folder / seed.target / ("seed_" + seed.name), seed.bytes);
  }
}

}  // namespace aspic::fuzz

int main(int count, char** arguments) {
  using namespace aspic::fuzz;
  if (count != 2) {
    std::fprintf(stderr, "usage: seeds FOLDER, for example fuzz\n");
    return 2;
  }
  const std::filesystem::path folder = arguments[1];
  for (const auto seeds : {mesh_seeds, vtu_seeds, part_seeds, record_seeds, scene_seeds, viewer_seeds})
    write_seeds(folder / "corpus", seeds());
  std::filesystem::create_directories(folder / "dictionaries");
  for (const Dictionary& dictionary : dictionaries())
    aspic::write_file(folder / "dictionaries" / (dictionary.target + ".dict"), dictionary.text);
}
