// The pins of one side: those of its scene, edited by hand.
#pragma once
#include <memory>
#include <vector>

#include "dynamics/model.h"

namespace aspic::viewer {

class PinSet {
 public:
  using Shared = std::shared_ptr<const std::vector<Pin>>;

  explicit PinSet(const Model& model);

  const std::vector<Pin>& of_scene() const { return *of_scene_; }
  const Shared& now() const { return now_; }
  bool has(int vertex) const { return pinned_[vertex]; }
  // The current pins plus vertices of the model at their positions in x, or minus these vertices.
  std::vector<Pin> painted(const std::vector<int>& vertices, bool pinned, Positions x) const;
  void set(Shared pins);

 private:
  Shared of_scene_, now_;
  std::vector<char> pinned_;  // by vertex
};

}  // namespace aspic::viewer
