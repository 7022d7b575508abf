// A rigid indenter in contact with the surface of a body: V(x) = sum over surface points of (area k phi), an elastic
// layer that is much stiffer than the body. The pose of the indenter is prescribed; its force results.
//   sliding: phi grows with the depth d of the point below the surface of the indenter:
//            phi' = d^2 / (2 e) up to d = e, then d - e / 2, where e = radius / 50
//   bonded:  phi = |x - target|^2 / 2 for the points that the indenter touches at rest, which follow it as if glued to
//   it
// The points are the centroids of equal parts of the boundary triangles. Their distance is at most an eighth (bonded)
// or a sixteenth (sliding) of the radius.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>

#include "energy/energy.h"
#include "mesh/tet_mesh.h"

namespace aspic {

enum class IndenterShape { sphere, disc };  // disc: the flat end of a cylinder with a rounded rim
enum class IndenterContact { sliding, bonded };

struct Indenter {
  IndenterShape shape = IndenterShape::sphere;
  IndenterContact contact = IndenterContact::bonded;
  double radius = 0;     // [m]
  double stiffness = 0;  // stiffness k of the layer [Pa/m]
  double friction = 0;   // coefficient, of a sliding indenter; see ProbeFriction
  double rim = 0;        // radius of the rounded rim of a disc [m]; 0: usual_rim()
};

// Pose of an indenter: the center of the sphere or of the flat end, its axis, and its rotation since it touched the
// body at rest.
struct IndenterPose {
  Vec3d center{};          // [m]
  Vec3d axis{{0, 0, -1}};  // points out of the indenter; any length except 0
  Vec3d rotation{};        // rotation vector about the center [rad]
};

struct PlacedIndenter {
  explicit PlacedIndenter(const IndenterPose& given);  // throws InvalidInput for an axis of length 0
  IndenterPose pose;                                   // with a unit axis
  Mat3d turn;                                          // rotation matrix
};

struct Wrench {
  Vec3d force{};   // force of the indenter on the body [N]
  Vec3d torque{};  // torque about the center of the indenter [N m]
};
inline Wrench operator+(const Wrench& a, const Wrench& b) { return {a.force + b.force, a.torque + b.torque}; }

// A surface point in contact, with the derivatives of its energy by its position.
struct TouchedPoint {
  Triangle vertices;
  std::array<double, 3> weights;  // of the vertices
  Vec3d position{}, gradient{};
  Mat3d hessian{};
};

class Probe : public SteadyEnergy {
 public:
  using SteadyEnergy::add_gradient, SteadyEnergy::add_hessian, SteadyEnergy::value;
  virtual void set_pose(const IndenterPose& pose) = 0;
  virtual const PlacedIndenter& placed() const = 0;
  const IndenterPose& pose() const { return placed().pose; }
  virtual Wrench wrench(Positions x) const = 0;
  // Computes d(wrench)/dx . dx and its transpose: xbar += scale (d(wrench)/dx)' wbar. dx, xbar: 3 entries per vertex.
  virtual Wrench wrench_product(Positions x, std::span<const double> dx) const = 0;
  virtual void add_wrench_transposed(Positions x, const Wrench& wbar, double scale, std::span<double> xbar) const = 0;
  virtual int touched_points(Positions x) const = 0;  // number of surface points in contact; 0: none
  // Adds scale times the derivative of the gradient by the logarithm of the rim of a sliding disc to g, and returns
  // that of the wrench. Other indenters have none.
  virtual Wrench add_rim_gradient(Positions x, double scale, std::span<double> g) const = 0;
  virtual void visit_touched(Positions x, const std::function<void(const TouchedPoint&)>& visit) const = 0;

  // V and its derivatives for another placement of the indenter.
  virtual double value_at(const PlacedIndenter& indenter, Positions x) const = 0;
  virtual void add_gradient_at(const PlacedIndenter& indenter, Positions x, double scale,
                               std::span<double> g) const = 0;
  virtual int add_hessian_at(const PlacedIndenter& indenter, Positions x, double scale, const Projection& projection,
                             BlockSparse& H) const = 0;

  double value(Positions x, const Context&) const override { return value_at(placed(), x); }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    add_gradient_at(placed(), x, scale, g);
  }
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return add_hessian_at(placed(), x, scale, projection, H);
  }
};

// Range of the glue from the surface of a bonded indenter, relative to the radius. The glue fades out over the second
// half of this distance. On a flat face, the footprint of a sphere is thus about as wide as the sphere. The footprint
// of a disc is the disc; its glue fades out over an eighth of the radius around its edge.
inline constexpr double kGlue = 0.5;

// `surface`: boundary triangles of the mesh, outward oriented. `touch`: initial pose, in which the indenter touches the
// body at rest. Throws InvalidInput if a bonded indenter touches nothing, or if a triangle that it touches is more than
// 32 times as long as the indenter is wide.
std::unique_ptr<Probe> make_probe(const TetMesh& mesh, std::span<const Triangle> surface, const Indenter& indenter,
                                  const IndenterPose& touch);

// Returns the number of points of `surface` that a valid indenter touches at rest; 0: none.
int touched_points_at_rest(const TetMesh& mesh, std::span<const Triangle> surface, const Indenter& indenter,
                           const IndenterPose& touch);

}  // namespace aspic
