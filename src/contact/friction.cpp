#include "contact/friction.h"

#include <algorithm>
#include <cmath>

#include "math/vectors.h"

namespace aspic {
namespace {

constexpr double kStaticReach = 1e-2;  // width of f in statics, relative to the reach of the barrier

struct Slider {
  std::array<int, 4> row;  // -1: an obstacle
  std::array<double, 4> weight;
  std::array<Vec3d, 2> tangent;
  double force;  // mu lambda [N]
  double width;  // e [m]
};

struct FrictionContext : Energy::Context {
  std::vector<double> start;
  std::vector<Slider> sliders;
};

const FrictionContext& friction(const Energy::Context& context) { return static_cast<const FrictionContext&>(context); }

struct Dissipation {
  double value, first, second;  // f, f', f''
};

Dissipation dissipation(double y, double e) {
  if (y >= e) return {y - e / 3, 1, 0};
  const double s = y / e;
  return {y * s * (1 - s / 3), s * (2 - s), 2 * (1 - s) / e};
}

// The tangential relative displacement since the start.
std::array<double, 2> slip(const Slider& slider, Positions x, Positions start) {
  Vec3d d{};
  for (int i = 0; i < 4; ++i)
    if (slider.row[i] >= 0) d = d + slider.weight[i] * (point(x, slider.row[i]) - point(start, slider.row[i]));
  return {dot(slider.tangent[0], d), dot(slider.tangent[1], d)};
}

}  // namespace

std::unique_ptr<Energy::Context> Friction::make_context() const { return std::make_unique<FrictionContext>(); }

void Friction::begin_step(const StepContext& step, Context& context) const {
  Energy::begin_step(step, context);
  auto& own = static_cast<FrictionContext&>(context);
  own.start.assign(step.start.begin(), step.start.end());
  update_lagged(step.shape.empty() ? step.start : step.shape, context);
}

bool Friction::update_lagged(Positions x, Context& context) const {
  auto& own = static_cast<FrictionContext&>(context);
  const ContactMesh& mesh = barrier_.mesh();
  own.sliders.clear();
  for (const ContactStencil& stencil : *barrier_.stencils(x)) {
    const ContactLaw& law = barrier_.laws()(stencil.parts[0], stencil.parts[1]);
    const double lambda = -stencil.weight * stencil.b().first;
    if (!(law.friction * lambda > 0)) continue;
    Slider slider{.row = {-1, -1, -1, -1},
                  .weight = {},
                  .tangent = tangents(stencil.distance),
                  .force = law.friction * lambda,
                  .width = context.h > 0 ? speed_ * context.h : kStaticReach * law.reach};
    for (int k = 0; k < stencil.distance.count; ++k) {
      const int p = stencil.point[stencil.distance.point[k]];
      if (p < 0 || mesh.row[p] < 0) continue;
      slider.row[k] = mesh.row[p];
      slider.weight[k] = stencil.distance.c[k];
    }
    own.sliders.push_back(slider);
  }
  return true;
}

double Friction::value(Positions x, const Context& context) const {
  const FrictionContext& own = friction(context);
  double sum = 0;
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    sum += slider.force * dissipation(std::hypot(u[0], u[1]), slider.width).value;
  }
  return sum;
}

void Friction::add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const {
  const FrictionContext& own = friction(context);
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    const double y = std::hypot(u[0], u[1]);
    if (y == 0) continue;
    const double size = scale * slider.force * dissipation(y, slider.width).first / y;
    const Vec3d force = (size * u[0]) * slider.tangent[0] + (size * u[1]) * slider.tangent[1];
    for (int i = 0; i < 4; ++i)
      if (slider.row[i] >= 0) add_vec(slider.weight[i] * force, slider.row[i], g);
  }
}

// f is convex, so the Hessian needs no modification.
int Friction::add_hessian(Positions x, const Context& context, double scale, const Projection&, BlockSparse& H) const {
  const FrictionContext& own = friction(context);
  for (const Slider& slider : own.sliders) {
    const auto u = slip(slider, x, own.start);
    const double y = std::hypot(u[0], u[1]);
    const Dissipation f = dissipation(y, slider.width);
    const double across = y > 0 ? f.first / y : 2 / slider.width, along = f.second;
    Mat3d K{};
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) {
        const double k = (a == b ? across : 0) + (y > 0 ? (along - across) * u[a] * u[b] / (y * y) : 0);
        for (int c = 0; c < 3; ++c)
          for (int r = 0; r < 3; ++r) K(r, c) += scale * slider.force * k * slider.tangent[a][r] * slider.tangent[b][c];
      }
    Stencil added{.row = slider.row};
    int variables = 0;
    for (int i = 0; i < 4; ++i) {
      if (slider.row[i] < 0) continue;
      ++variables;
      Mat3d& diagonal = H.block[H.pattern->diagonal(slider.row[i])];
      diagonal = diagonal + (slider.weight[i] * slider.weight[i]) * K;
      for (int j = 0; j < i; ++j) added.block[i * (i - 1) / 2 + j] = (slider.weight[i] * slider.weight[j]) * K;
    }
    if (variables > 1) H.stencils.push_back(added);
  }
  return 0;
}

}  // namespace aspic
