// Formulas of a position and a time, such as "1e5 * (1 + 3 * exp(-Y^2 / 0.02))" and "y > 0.9 && x < 0".
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "math/small.h"

namespace aspic {

inline constexpr size_t kMaxExpressionLength = 1000;  // characters; bounds the evaluation time
inline constexpr int kMaxExpressionDepth = 50;        // open parentheses

enum class ExpressionVariables {
  plane_position,     // X, Y, or x, y for the same
  position,           // X, Y, Z, or x, y, z for the same
  position_and_time,  // and t
};

class Expression {
 public:
  // Throws InvalidInput with the column, the reason and the nearest known name.
  explicit Expression(const std::string& text, ExpressionVariables variables = ExpressionVariables::position);

  // Returns a finite value, or throws InvalidInput with formula and point. Thread-safe.
  double at(const Vec3d& X, double t = 0) const;
  double evaluate(const Vec3d& X, double t = 0) const;  // infinite or NaN where undefined
  bool holds_at(const Vec3d& X) const { return at(X) != 0; }
  bool depends_on_time() const;
  bool depends_on_position() const;
  const std::string& text() const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

struct NamedMeaning {
  std::string name, meaning;  // empty meaning: self-explanatory name
};
std::vector<NamedMeaning> expression_functions();  // for the reference
std::vector<NamedMeaning> expression_constants();

}  // namespace aspic
