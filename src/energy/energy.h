// One term V_k(x) of the potential energy. A call covers all the elements of the term.
#pragma once
#include <limits>
#include <span>
#include <string_view>

#include "linalg/block_sparse.h"
#include "linalg/projection.h"

namespace aspic {

using Positions = std::span<const double>;  // x, 3 per vertex [m]
inline Vec3d point(Positions x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

// A step, or a stage of one: what an integrator says is a step from `start` that takes h, so that (x - start) / h is
// the velocity.
struct StepContext {
  Positions start;  // x at the start of the step
  double h = 0;     // length of the step [s]; 0 in statics
  double time = 0;  // of the forces: the end of the step [s], the start in explicit schemes
  // Where coefficients that depend on x are taken, when not at `start`, which may be extrapolated and inside out.
  Positions shape = {};
};

class Energy {
 public:
  virtual ~Energy() = default;
  virtual std::string_view name() const = 0;
  virtual bool has_constant_gradient() const { return false; }  // the same at all x, and so free of round-off

  // Called before each stage of a step: moving targets follow the time, damping remembers the start.
  virtual void begin_step(const StepContext&) {}

  virtual double value(Positions x) const = 0;  // V(x) [J]; +inf where undefined
  virtual void add_gradient(Positions x, double scale, std::span<double> g) const = 0;  // g += scale dV/dx
  virtual void add_couplings(Couplings&) const {}  // which vertices share a 3x3 block
  virtual void bind(const BlockPattern&) {}        // remember my slots
  // H += scale d2V/dx2; returns how many elements were projected.
  virtual int add_hessian(Positions x, double scale, const Projection& projection, BlockSparse& H) const = 0;
  // For methods that move one vertex at a time: makes what add_vertex_systems needs, once. False: not offered; those
  // methods then take the whole gradient and Hessian.
  virtual bool prepare_vertex_systems(int /*vertex_count*/) { return false; }
  // g[k] += scale dV/dx_v, H[k] += scale d2V/dx_v^2 for v = vertices[k]. Several threads may call it at once.
  virtual void add_vertex_systems(Positions, double, std::span<const int>, std::span<Vec3d>, std::span<Mat3d>) const {}
  virtual double max_step(Positions, std::span<const double>) const {  // largest safe alpha along d
    return std::numeric_limits<double>::infinity();
  }
};

}  // namespace aspic
