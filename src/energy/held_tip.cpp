#include "energy/held_tip.h"

#include "mesh/surface.h"

namespace aspic {

TipPose Poke::pose(double time) const {
  if (time >= to_time) return to;
  if (time <= from_time) return from;
  const double s = (time - from_time) / (to_time - from_time);
  return {(1 - s) * from.center + s * to.center, (1 - s) * from.axis + s * to.axis,
          (1 - s) * from.rotation + s * to.rotation};
}

HeldTip::HeldTip(const TetMesh& mesh)
    : mesh_{.rest = mesh.rest, .tets = {}}, surface_(boundary_triangles(mesh, 0, mesh.tet_count())) {}
HeldTip::~HeldTip() = default;

std::unique_ptr<Probe> HeldTip::made(const Touch& touch) const {
  std::unique_ptr<Probe> probe = make_probe(mesh_, surface_, touch.tip, touch.rest);
  if (pattern_) probe->bind(*pattern_);
  if (vertex_count_) probe->prepare_vertex_systems(*vertex_count_);
  return probe;
}

void HeldTip::set(const Poke& poke, double time) {
  if (poke.touch != poke_.touch) probe_ = poke.touch ? made(*poke.touch) : nullptr;
  poke_ = poke;
  if (probe_) probe_->set_pose(poke_.pose(time));
}

Wrench HeldTip::wrench(Positions x) const { return probe_ ? probe_->wrench(x) : Wrench{}; }
int HeldTip::touched_points(Positions x) const { return probe_ ? probe_->touched_points(x) : 0; }

void HeldTip::begin_step(const StepContext& step) {
  if (probe_) probe_->set_pose(poke_.pose(step.time));
}

double HeldTip::value(Positions x) const { return probe_ ? probe_->value(x) : 0; }

void HeldTip::add_gradient(Positions x, double scale, std::span<double> g) const {
  if (probe_) probe_->add_gradient(x, scale, g);
}

void HeldTip::bind(const BlockPattern& pattern) {
  pattern_ = &pattern;
  if (probe_) probe_->bind(pattern);
}

int HeldTip::add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const {
  return probe_ ? probe_->add_hessian(x, scale, projection, H) : 0;
}

bool HeldTip::prepare_vertex_systems(int vertex_count) {
  vertex_count_ = vertex_count;
  return !probe_ || probe_->prepare_vertex_systems(vertex_count);
}

void HeldTip::add_vertex_systems(Positions x, double scale, std::span<const int> vertices, std::span<Vec3d> g,
                                 std::span<Mat3d> H) const {
  if (probe_) probe_->add_vertex_systems(x, scale, vertices, g, H);
}

}  // namespace aspic
