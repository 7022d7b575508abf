#include "ranks/sliced_body.h"

#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "io/gmsh_slices.h"
#include "mesh/generators.h"
#include "scene/body_mesh.h"

namespace aspic::distributed {
namespace {

class BoxBody : public SlicedBody {
 public:
  BoxBody(const Value& box, const BoxCells& cells) : count_(cells.count), tets_(cells.tets()) {
    if (tets_ <= std::numeric_limits<int>::max())
      grid_.emplace(box["lower"].vector(), box["upper"].vector(), cells.integers(), cells.cut);
  }

  double vertex_count() const override { return (count_[0] + 1) * (count_[1] + 1) * (count_[2] + 1); }
  double tet_count() const override { return tets_; }

  std::vector<Vec3d> vertices(int first, int count) const override {
    std::vector<Vec3d> result;
    for (int v = first; v < first + count; ++v) result.push_back(grid_->position(v));
    return result;
  }

  std::vector<Tet> tets(int first, int count) const override {
    std::vector<Tet> result, of_cell;
    const auto [nx, ny, nz] = grid_->cells();
    const int per_cell = grid_->tets_per_cell();
    for (int t = first; t < first + count;) {
      const int cell = t / per_cell;
      of_cell.clear();
      grid_->append_cell(cell / (ny * nz), cell / nz % ny, cell % nz, of_cell);
      for (; t < first + count && t / per_cell == cell; ++t) result.push_back(of_cell[t % per_cell]);
    }
    return result;
  }

  bool has_regions() const override { return false; }
  int region(int) const override { return 0; }

  std::vector<Vec3d> corners() const override {
    const auto [nx, ny, nz] = grid_->cells();
    std::vector<Vec3d> result;
    for (int corner = 0; corner < 8; ++corner)
      result.push_back(grid_->position(grid_->vertex(corner & 1 ? nx : 0, corner & 2 ? ny : 0, corner & 4 ? nz : 0)));
    return result;
  }

  bool is_file() const override { return false; }

 private:
  std::array<double, 3> count_;
  double tets_;
  std::optional<BoxGrid> grid_;  // empty: too many tets
};

class FileBody : public SlicedBody {
 public:
  explicit FileBody(GmshSlices file) : file_(std::move(file)) {}

  double vertex_count() const override { return static_cast<double>(file_.vertex_count()); }
  double tet_count() const override { return static_cast<double>(file_.tet_count()); }
  std::vector<Vec3d> vertices(int first, int count) const override { return file_.vertices(first, count); }
  std::vector<Tet> tets(int first, int count) const override { return file_.tets(first, count); }
  bool has_regions() const override { return file_.has_regions(); }
  int region(int tet) const override { return file_.has_regions() ? file_.region(tet) : 0; }
  std::vector<Vec3d> corners() const override { return {}; }
  bool is_file() const override { return true; }

 private:
  GmshSlices file_;
};

}  // namespace

std::unique_ptr<SlicedBody> sliced_body(const Value& body, const SceneFiles& files) {
  if (const Value* shape = body.find("shape")) {
    const Value* box = shape->find("box");
    return box ? std::make_unique<BoxBody>(*box, cells_of(*box)) : nullptr;
  }
  if (body.find("mesh_size")) return nullptr;
  const std::filesystem::path path = files.find(body["mesh"]);
  std::optional<GmshSlices> file;
  if (path.extension() == ".msh") file = GmshSlices::open(path);
  return file ? std::make_unique<FileBody>(std::move(*file)) : nullptr;
}

}  // namespace aspic::distributed
