#include "labeled.h"

#include <algorithm>

namespace aspic {
namespace {

// Edge length of the region at a point; on a surface, of the finer of its two regions.
class RegionSize {
 public:
  using Index = LabeledDomain::Index;

  RegionSize(const LabeledDomain& domain, const MesherOptions& options) : domain_(&domain), options_(&options) {}

  double operator()(const Point&, int dimension, const Index& index) const {
    if (options_->region_size.empty()) return options_->size;
    if (dimension == 3) return region(static_cast<int>(domain_->subdomain_index(index)));
    const auto patch = domain_->surface_patch_index(index);
    return std::min(region(static_cast<int>(patch.first)), region(static_cast<int>(patch.second)));
  }

 private:
  double region(int label) const {
    const auto found = options_->region_size.find(label);
    return found == options_->region_size.end() ? options_->size : found->second;
  }

  const LabeledDomain* domain_;
  const MesherOptions* options_;
};

double smallest_size(const MesherOptions& options) {
  double smallest = options.size;
  for (const auto& [label, size] : options.region_size) smallest = std::min(smallest, size);
  return smallest;
}

}  // namespace

TetMesh mesh_labeled(const std::string& name, const LabeledDomain& domain, const LabelGrid& grid,
                     const MesherOptions& options) {
  // With tets of the smallest size in the whole box there is about one vertex per five tets.
  const double size = smallest_size(options), cells = grid.box_volume() / (0.11785 * size * size * size);
  const auto most_vertices = static_cast<size_t>(5e4 + std::min(cells, 1e9));
  bool is_complete = false;
  const RegionSize edge(domain, options);
  const Seeds<LabeledDomain> seeds = grid.seeds();
  TetMesh mesh = filled(Filling<LabeledDomain, RegionSize>{domain, edge, seeds, most_vertices}, is_complete);
  if (!is_complete)
    throw InvalidInput(name + ": refinement did not end within " + std::to_string(most_vertices) +
                       " vertices: the border between its regions is too rough for edges of this length; smooth the "
                       "labels, or give a --size of about a voxel");
  if (mesh.tets.empty()) throw InvalidInput(name + ": no tet fits into the shape; give a smaller --size");
  return mesh;
}

}  // namespace aspic
