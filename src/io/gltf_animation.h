// Animations of the nodes of a glTF file.
#pragma once
#include <array>
#include <string>
#include <vector>

#include "io/gltf_file.h"

namespace aspic {

// Transform of a node relative to its parent: scale, then rotation by a quaternion x y z w, then translation.
struct GltfTransform {
  std::array<double, 3> translation = {0, 0, 0};
  std::array<double, 4> rotation = {0, 0, 0, 1};
  std::array<double, 3> scale = {1, 1, 1};
};

class GltfAnimation {
 public:
  // Reads the animation of this name; empty: the only one. Throws InvalidInput.
  GltfAnimation(GltfFile& file, const std::string& name);

  size_t channel_count() const { return channels_.size(); }
  double duration() const;  // time of the last keyframe [s]
  // Overwrites what the animation moves, by numbers of nodes. Constant before the first keyframe and after the last.
  void apply(double time, std::vector<GltfTransform>& nodes) const;

 private:
  enum class Interpolation { step, linear, cubic };
  struct Channel {
    uint64_t node;
    std::string path;  // translation, rotation, scale
    Interpolation interpolation;
    std::vector<double> times, values;  // cubic: incoming tangent, value, outgoing tangent per time

    std::array<double, 4> at(double time) const;
  };

  void add_channel(GltfFile& file, const GltfFile::Json& animation, const GltfFile::Json& channel);
  void read_sampler(GltfFile& file, const GltfFile::Json& sampler, Channel& channel) const;

  std::vector<Channel> channels_;
};

}  // namespace aspic
