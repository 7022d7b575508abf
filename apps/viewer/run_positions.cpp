#include "viewer/run_positions.h"

#include <system_error>

#include "base/error.h"
#include "io/pc2.h"
#include "io/vtu.h"

namespace aspic::viewer {
namespace {

namespace fs = std::filesystem;

class BodyFrames : public RunPositions {
 public:
  BodyFrames(const RunLayout& layout, const Model& model) : layout_(layout), model_(model) {}

  std::vector<double> frame(int index) override {
    const fs::path file = layout_.root() / layout_.file_of_frame(index);
    const std::vector<double> x = points_of(file);
    const size_t expected = 3 * model_.mesh.rest.size();
    if (x.size() != expected)
      throw InvalidInput(file.string() + ": has " + std::to_string(x.size() / 3) + " points; the scene has " +
                         std::to_string(expected / 3) + " vertices");
    return model_.numbering.vertex.from_user(x, 3);
  }
  std::vector<double> mesh_error(int index) override {
    const fs::path file = layout_.root() / layout_.file_of_frame(index);
    for (const aspic::Field& field : read_frame(file).cell_fields) {
      if (field.name != "mesh_error") continue;
      if (field.values.size() != model_.mesh.tets.size())
        throw InvalidInput(file.string() + ": mesh_error has " + std::to_string(field.values.size()) +
                           " values; the scene has " + std::to_string(model_.mesh.tets.size()) + " tets");
      return model_.numbering.tet.from_user(field.values);
    }
    return {};
  }
  bool are_of_model() const override { return true; }

 private:
  static std::vector<double> points_of(const fs::path& file) {
    if (file.extension() != ".pvtu") return read_vtu_points(file);
    std::vector<double> x;
    for (const Vec3d& point : read_pvtu(file).mesh.rest) x.insert(x.end(), point.a, point.a + 3);
    return x;
  }

  RunLayout layout_;
  const Model& model_;
};

class SkinCaches : public RunPositions {
 public:
  SkinCaches(const RunLayout& layout, const Scene& scene, int frames) {
    std::vector<std::string> bodies;
    for (const Skin& skin : scene.skins) bodies.push_back(skin.body);
    const std::vector<std::string> names = file_names(bodies);
    for (size_t i = 0; i < names.size(); ++i) {
      const fs::path file = layout.skin_cache(names[i]);
      const Pc2Reader& cache = caches_.emplace_back(file);
      const int points = scene.skins[i].rest.vertex_count();
      if (cache.points() != points || cache.samples() < frames)
        throw InvalidInput(file.string() + ": holds " + std::to_string(cache.samples()) + " samples of " +
                           std::to_string(cache.points()) + " points; the run has " + std::to_string(frames) +
                           " frames of " + std::to_string(points));
    }
  }

  std::vector<double> frame(int index) override {
    std::vector<double> x;
    for (Pc2Reader& cache : caches_) {
      const std::vector<float> sample = cache.sample(index);
      x.insert(x.end(), sample.begin(), sample.end());
    }
    return x;
  }
  std::vector<double> mesh_error(int) override { return {}; }
  bool are_of_model() const override { return false; }

 private:
  std::vector<Pc2Reader> caches_;
};

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::exists(file, error);
}

}  // namespace

std::unique_ptr<RunPositions> run_positions(const RunLayout& layout, const Scene& scene, int frames) {
  if (is_there(layout.root() / layout.file_of_frame(0)))
    return std::make_unique<BodyFrames>(layout, scene.simulation.model());
  if (!scene.skins.empty() && is_there(layout.skins())) return std::make_unique<SkinCaches>(layout, scene, frames);
  throw InvalidInput(layout.root().string() +
                     ": holds neither frames nor skins that show its motion; run it again with output.vtu = true (or "
                     "output.pc2 = true, for the surface alone)");
}

}  // namespace aspic::viewer
