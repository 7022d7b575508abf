#include <CGAL/Image_3.h>

#include <cmath>

#include "labeled.h"
#include "unit_frame.h"

namespace aspic {
namespace {

CGAL::Image_3 read_image(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) throw InvalidInput(path.string() + ": no such file");
  CGAL::Image_3 image;
  if (!image.read(path.string()))
    throw InvalidInput(path.string() + ": not an INRIMAGE that can be read; save the labels as .inr or .inr.gz");
  if (image.image()->vdim != 1)
    throw InvalidInput(path.string() + ": " + std::to_string(image.image()->vdim) +
                       " values per voxel; a labeled image has one");
  if (image.image()->wordKind != WK_FIXED)
    throw InvalidInput(path.string() + ": voxels are not integers; a labeled image has one integer label per voxel");
  return image;
}

CGAL::Bbox_3 bounding_box(const CGAL::Image_3& image) {
  const double x = image.tx(), y = image.ty(), z = image.tz();
  return {x,
          y,
          z,
          x + image.vx() * static_cast<double>(image.xdim() - 1),
          y + image.vy() * static_cast<double>(image.ydim() - 1),
          z + image.vz() * static_cast<double>(image.zdim() - 1)};
}

// Labels exist up to the border of the image; one voxel beyond it they are 0.
CGAL::Bbox_3 widened_by_voxel(const CGAL::Bbox_3& box, const CGAL::Image_3& image) {
  return {box.xmin() - image.vx(), box.ymin() - image.vy(), box.zmin() - image.vz(),
          box.xmax() + image.vx(), box.ymax() + image.vy(), box.zmax() + image.vz()};
}

std::vector<Vec3d> corners(const CGAL::Bbox_3& box) {
  return {{{box.xmin(), box.ymin(), box.zmin()}}, {{box.xmax(), box.ymax(), box.zmax()}}};
}

void to_frame(const UnitFrame& frame, CGAL::Image_3& image) {
  auto* const voxels = image.image();
  voxels->vx /= frame.unit, voxels->vy /= frame.unit, voxels->vz /= frame.unit;
  voxels->tx = static_cast<decltype(voxels->tx)>((voxels->tx - frame.origin[0]) / frame.unit);
  voxels->ty = static_cast<decltype(voxels->ty)>((voxels->ty - frame.origin[1]) / frame.unit);
  voxels->tz = static_cast<decltype(voxels->tz)>((voxels->tz - frame.origin[2]) / frame.unit);
}

}  // namespace

TetMesh mesh_image(const std::filesystem::path& path, const MesherOptions& options) {
  CGAL::Image_3 image = read_image(path);
  const UnitFrame frame = unit_frame(path.string(), corners(widened_by_voxel(bounding_box(image), image)));
  to_frame(frame, image);
  const CGAL::Bbox_3 box = bounding_box(image);
  MesherOptions in_frame = options;
  in_frame.size =
      options.size > 0 ? options.size / frame.unit : std::hypot(box.x_span(), box.y_span(), box.z_span()) / 25;
  for (auto& [label, size] : in_frame.region_size) size /= frame.unit;
  check_size(frame.unit * Vec3d{{box.x_span(), box.y_span(), box.z_span()}}, in_frame.size * frame.unit);
  const LabeledDomain domain = LabeledDomain::create_labeled_image_mesh_domain(
      image, CGAL::parameters::relative_error_bound = kSurfaceTolerance);
  const LabelGrid grid(domain, widened_by_voxel(box, image), std::min({image.vx(), image.vy(), image.vz()}));
  if (grid.is_empty()) throw InvalidInput(path.string() + ": all labels are 0; there is nothing to fill");
  for (const auto& [label, unused] : options.region_size)
    if (!grid.has(label))
      throw InvalidInput("--region-size: " + path.string() + " has no label " + std::to_string(label));
  TetMesh mesh = mesh_labeled(path.string(), domain, grid, in_frame);
  from_frame(frame, mesh.rest);
  return mesh;
}

}  // namespace aspic
