// Placement of a body: rest shape, shape at time 0, velocity.
#pragma once
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "math/small.h"
#include "mesh/box.h"
#include "scene/expression.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic {

class WholeBody;

struct AffineMap {
  Mat3d A = identity3<double>();
  Vec3d b{};
  Vec3d operator()(const Vec3d& X) const { return A * X + b; }
};

Mat3d rotation(const Vec3d& axis, double angle /* [rad] */);  // the axis has any length but 0

AffineMap placement_of(const Value& body);  // scale, then rotate, then translate
// Maps points. A function for all programs, because inlined code may round differently.
void place(const AffineMap& map, std::span<Vec3d> points);

// Coordinates of a body: those of its mesh file, after `scale`, or after the whole placement.
enum class Frame { mesh, scaled, placed };
AffineMap from_placed(const Value& body, Frame frame);  // maps placed points to that frame

// Returns the shape at time 0 of the placed rest shape X. Files are added to the results as `stem`. `whole`: null if X
// is the whole body.
std::vector<Vec3d> deformed(Value& body, const std::vector<Vec3d>& X, SceneFiles& files, const std::string& stem,
                            const WholeBody* whole = nullptr);

// Returns velocity(X) + omega x (x - center of mass).
std::vector<Vec3d> velocities(const Value& body, const std::vector<Vec3d>& X, const std::vector<Vec3d>& x,
                              std::span<const double> vertex_mass);

// A vector of numbers or formulas at points.
class VectorField {
 public:
  explicit VectorField(const Value& value, ExpressionVariables variables = ExpressionVariables::position);
  Vec3d at(const Vec3d& X, double t = 0) const;
  bool depends_on_time() const;

 private:
  std::vector<double> number_;  // NaN: the formula applies
  std::vector<Expression> formula_;
};

// Returns a number or a formula of t as a function that throws InvalidInput at the place of `value`, possibly long
// after the scene was read. `only_time`: why X, Y and Z are refused.
std::function<double(double t)> function_of_time(const Value& value, const std::string& only_time);

}  // namespace aspic
