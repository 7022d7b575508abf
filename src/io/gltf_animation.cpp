#include "io/gltf_animation.h"

#include <algorithm>
#include <cmath>

#include "base/printable.h"

namespace aspic {
namespace {

using Json = GltfFile::Json;
using Numbers = std::array<double, 4>;

std::string text_of(const Json& object, const char* key) {
  const Json* found = GltfFile::member(object, key);
  return found && found->is_string() ? found->get<std::string>() : "";
}

const Json& choose(const GltfFile& file, const std::string& name) {
  const Json& animations = file.list("animations");
  if (animations.empty()) file.fail("it has no animation", "remove the recording, or export the animation");
  if (animations.size() == 1 && name.empty()) return animations[0];
  std::string names;
  for (const Json& animation : animations) {
    if (!name.empty() && text_of(animation, "name") == name) return animation;
    if (names.size() < 200) names += (names.empty() ? "" : ", ") + shown(text_of(animation, "name"));
  }
  const std::string count = std::to_string(animations.size()) + " animations: " + names;
  file.fail(name.empty() ? "it has " + count : "animation = " + shown(name) + " is none of its " + count,
            "choose one of them by `animation`");
}

double product(const Numbers& a, const Numbers& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

// The weights of two quaternions for the shorter arc between them [Khronos, C.4].
std::array<double, 2> arc_weights(const Numbers& a, const Numbers& b, double share) {
  const double cosine = product(a, b), angle = std::acos(std::min(1.0, std::abs(cosine))), sine = std::sin(angle);
  const double sign = cosine < 0 ? -1 : 1;
  if (sine < 1e-8) return {1 - share, sign * share};
  return {std::sin((1 - share) * angle) / sine, sign * std::sin(share * angle) / sine};
}

}  // namespace

GltfAnimation::GltfAnimation(GltfFile& file, const std::string& name) {
  const Json& animation = choose(file, name);
  for (const Json& channel : file.list(animation, "channels")) add_channel(file, animation, channel);
  if (channels_.empty()) file.fail("its animation moves no node", "remove the recording, or export the animation");
}

double GltfAnimation::duration() const {
  double last = 0;
  for (const Channel& channel : channels_) last = std::max(last, channel.times.back());
  return last;
}

void GltfAnimation::add_channel(GltfFile& file, const Json& animation, const Json& channel) {
  const Json* target = GltfFile::member(channel, "target");
  if (!target || !target->contains("node")) return;  // of an extension
  Channel added{.node = file.integer(*target, "node", "a channel"), .path = text_of(*target, "path")};
  const std::string owner = GltfFile::name("nodes", added.node);
  if (file.item("nodes", added.node).contains("matrix"))
    file.fail(owner + " has a matrix and an animation", "export translation, rotation and scale");
  if (added.path == "weights")
    file.fail("its animation moves the morph targets of " + owner, "bake them to a PC2 cache, or remove them");
  if (added.path != "translation" && added.path != "rotation" && added.path != "scale")
    file.fail("a channel has the path " + shown(added.path));
  const Json& samplers = file.list(animation, "samplers");
  const uint64_t index = file.integer(channel, "sampler", "a channel");
  if (index >= samplers.size())
    file.fail("a channel names " + GltfFile::name("samplers", index) + ", which is missing");
  read_sampler(file, samplers[index], added);
  channels_.push_back(std::move(added));
}

void GltfAnimation::read_sampler(GltfFile& file, const Json& sampler, Channel& channel) const {
  const std::string kind =
      sampler.is_object() && sampler.contains("interpolation") ? text_of(sampler, "interpolation") : "LINEAR";
  if (kind != "STEP" && kind != "LINEAR" && kind != "CUBICSPLINE")
    file.fail("a sampler has the interpolation " + shown(kind));
  channel.interpolation = kind == "STEP"     ? Interpolation::step
                          : kind == "LINEAR" ? Interpolation::linear
                                             : Interpolation::cubic;
  const bool is_rotation = channel.path == "rotation";
  channel.times = file.reals(file.integer(sampler, "input", "a sampler"), "SCALAR");
  channel.values = file.reals(file.integer(sampler, "output", "a sampler"), is_rotation ? "VEC4" : "VEC3");
  if (channel.times.empty()) file.fail("a sampler has no keyframes");
  if (channel.times[0] < 0 ||
      std::adjacent_find(channel.times.begin(), channel.times.end(), std::greater_equal<>()) != channel.times.end())
    file.fail("the times of a sampler do not ascend from 0 or later");
  const size_t expected = channel.times.size() * (is_rotation ? 4 : 3) * (kind == "CUBICSPLINE" ? 3 : 1);
  if (channel.values.size() != expected)
    file.fail("a sampler has " + std::to_string(channel.values.size()) + " numbers; " + std::to_string(expected) +
              " are needed");
}

Numbers GltfAnimation::Channel::at(double time) const {
  const size_t next = std::upper_bound(times.begin(), times.end(), time) - times.begin();
  const size_t k = next == 0 ? 0 : next - 1, l = std::min(next, times.size() - 1);
  const size_t components = path == "rotation" ? 4 : 3, parts = interpolation == Interpolation::cubic ? 3 : 1;
  const double h = times[l] - times[k], s = l > k ? (time - times[k]) / h : 0;
  const auto value = [&](size_t keyframe, size_t part) {
    Numbers v = {};
    std::copy_n(values.begin() + static_cast<std::ptrdiff_t>((keyframe * parts + part) * components), components,
                v.begin());
    return v;
  };
  if (interpolation == Interpolation::step) return value(k, 0);
  if (interpolation == Interpolation::linear) {
    const Numbers a = value(k, 0), b = value(l, 0);
    const auto [p, q] = path == "rotation" ? arc_weights(a, b, s) : std::array<double, 2>{1 - s, s};
    return {p * a[0] + q * b[0], p * a[1] + q * b[1], p * a[2] + q * b[2], p * a[3] + q * b[3]};
  }
  const Numbers a = value(k, 1), leaving = value(k, 2), arriving = value(l, 0), b = value(l, 1);
  Numbers x;
  for (size_t c = 0; c < 4; ++c)
    x[c] = (1 + 2 * s) * (1 - s) * (1 - s) * a[c] + h * s * (1 - s) * (1 - s) * leaving[c] +
           s * s * (3 - 2 * s) * b[c] - h * s * s * (1 - s) * arriving[c];
  return x;
}

void GltfAnimation::apply(double time, std::vector<GltfTransform>& nodes) const {
  for (const Channel& channel : channels_) {
    GltfTransform& node = nodes[channel.node];
    const Numbers x = channel.at(time);
    if (channel.path == "rotation") {
      const double length = std::sqrt(product(x, x));
      node.rotation = {x[0] / length, x[1] / length, x[2] / length, x[3] / length};
    } else {
      (channel.path == "scale" ? node.scale : node.translation) = {x[0], x[1], x[2]};
    }
  }
}

}  // namespace aspic
