// The common parts of the messages about live and recorded scenes.
#pragma once
#include "mesh/box.h"
#include "scene/value.h"
#include "viewer/arguments.h"
#include "viewer/fields.h"

namespace aspic::viewer {

Json json_of(const Vec3d& x);

// Returns the bounding box of points with 3 numbers each. Ignores NaN.
template <class Real>
Box box_of(std::span<const Real> x) {
  Box box;
  for (size_t i = 0; i + 2 < x.size(); i += 3) box.add({{x[i], x[i + 1], x[i + 2]}});
  return box;
}

// Returns the obstacles of the message "obstacles"; empty without contact.
Json obstacles_json(const Model& model, double time);

// Returns the members of the message "scene" that live and recorded scenes share. `document`: the scene with all
// values. `start`: the bounding box of its first state, which the message extends by obstacles.
Json scene_json(const Scene& scene, const Table& document, const Box& start, const std::vector<Field>& fields);

}  // namespace aspic::viewer
