#include "indenter/held_indenter.h"

#include "mesh/surface.h"

namespace aspic {

IndenterPose IndenterMotion::pose(double time) const {
  if (time >= to_time) return to;
  if (time <= from_time) return from;
  const double s = (time - from_time) / (to_time - from_time);
  return {(1 - s) * from.center + s * to.center, (1 - s) * from.axis + s * to.axis,
          (1 - s) * from.rotation + s * to.rotation};
}

HeldIndenter::HeldIndenter(const TetMesh& mesh)
    : mesh_{.rest = mesh.rest, .tets = {}}, surface_(boundary_triangles(mesh, 0, mesh.tet_count())) {}
HeldIndenter::~HeldIndenter() = default;

std::unique_ptr<Probe> HeldIndenter::make(const FirstContact& touch) const {
  std::unique_ptr<Probe> probe = make_probe(mesh_, surface_, touch.indenter, touch.rest);
  if (pattern_) probe->bind(*pattern_);
  return probe;
}

void HeldIndenter::set(const IndenterMotion& poke) {
  if (poke.touch != poke_.touch) probe_ = poke.touch ? make(*poke.touch) : nullptr;
  poke_ = poke;
  if (probe_) probe_->set_pose(poke_.to);
}

double HeldIndenter::value(Positions x) const { return probe_ ? probe_->value_at(PlacedIndenter(poke_.to), x) : 0; }
Wrench HeldIndenter::wrench(Positions x) const { return probe_ ? probe_->wrench(x) : Wrench{}; }
int HeldIndenter::touched_points(Positions x) const { return probe_ ? probe_->touched_points(x) : 0; }

double HeldIndenter::value(Positions x, const Context& context) const {
  return probe_ ? probe_->value_at(PlacedIndenter(poke_.pose(context.time)), x) : 0;
}

void HeldIndenter::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  if (probe_) probe_->add_gradient_at(PlacedIndenter(poke_.pose(context.time)), x, scale, g);
}

void HeldIndenter::bind(const BlockPattern& pattern) {
  pattern_ = &pattern;
  if (probe_) probe_->bind(pattern);
}

int HeldIndenter::add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                              BlockSparse& H) const {
  return probe_ ? probe_->add_hessian_at(PlacedIndenter(poke_.pose(context.time)), x, scale, projection, H) : 0;
}

}  // namespace aspic
