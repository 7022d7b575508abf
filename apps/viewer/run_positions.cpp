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
  std::vector<double> cell_field(int index, std::string_view name) override {
    const fs::path file = layout_.root() / layout_.file_of_frame(index);
    const std::vector<double> values = cells_of(file, name);
    if (const int count = model_.mesh.element_count(); !values.empty() && std::ssize(values) != count)
      throw InvalidInput(file.string() + ": " + std::string(name) + " has " + std::to_string(values.size()) +
                         " values; the scene has " + std::to_string(count) + " elements");
    return values.empty() ? values : model_.numbering.tet.from_user(values);
  }
  bool are_of_model() const override { return true; }

 private:
  static std::vector<double> points_of(const fs::path& file) {
    if (file.extension() != ".pvtu") return read_vtu_points(file);
    std::vector<double> x;
    for (const Vec3d& point : read_pvtu(file).mesh.rest) x.insert(x.end(), point.a, point.a + 3);
    return x;
  }

  static std::vector<double> cells_of(const fs::path& file, std::string_view name) {
    if (file.extension() != ".pvtu") return read_vtu_cell_field(file, name);
    for (const Vtu whole = read_pvtu(file); const aspic::Field& field : whole.cell_fields)
      if (field.name == name) return field.values;
    return {};
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
  std::vector<double> cell_field(int, std::string_view) override { return {}; }
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
