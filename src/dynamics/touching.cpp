#include "dynamics/touching.h"

#include <map>

#include "contact/barrier.h"
#include "dynamics/settle.h"
#include "math/vectors.h"

namespace aspic {
namespace {

// Returns the shortest displacement with away . u >= by for all touches; zero if there is none.
Vec3d separation(const std::vector<const Touch*>& touches) {
  constexpr int kSweeps = 200;
  constexpr double kEnough = 0.999;
  Vec3d u{};
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    bool is_enough = true;
    for (const Touch* touch : touches)
      if (const double missing = touch->by - dot(touch->away, u); missing > (1 - kEnough) * touch->by) {
        u = u + missing * touch->away;
        is_enough = false;
      }
    if (is_enough) return u;
  }
  return {};
}

}  // namespace

std::set<std::array<int, 2>> separate_touching(Model& model, std::vector<double>& q) {
  if (!model.contact) return {};
  const std::vector<Touch> touches = model.contact->touches(q, 0);
  if (touches.empty() || !overlap(model, q)) return {};
  const std::set<int> pinned = pinned_vertices(model);
  std::map<int, std::vector<const Touch*>> of_vertex;
  std::set<std::array<int, 2>> pairs;
  for (const Touch& touch : touches) {
    pairs.insert(touch.parts);
    const int vertex = model.contact->mesh().row[touch.point];
    if (pinned.count(vertex) == 0) of_vertex[vertex].push_back(&touch);
  }
  const std::vector<double> start = q;
  for (const auto& [vertex, own] : of_vertex) add_vec(separation(own), vertex, q);
  if (overlap(model, q)) {
    q = start;
    return {};
  }
  without_other_terms(model, [&] { settle(model, start, q); });
  return pairs;
}

}  // namespace aspic
