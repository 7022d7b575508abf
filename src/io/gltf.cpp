#include "io/gltf.h"

#include <algorithm>
#include <cmath>

#include "base/check.h"
#include "io/number_text.h"

namespace aspic {
namespace {

enum ComponentType { kUnsignedInt = 5125, kFloat = 5126 };
enum ChunkType : uint32_t { kJson = 0x4e4f534a, kBinary = 0x004e4942 };

void append_word(std::string& bytes, uint32_t word) {
  for (int i = 0; i < 4; ++i) bytes += static_cast<char>(word >> (8 * i) & 0xff);
}

// Removes characters that JSON cannot contain.
std::string json_text(const std::string& name) {
  std::string text = "\"";
  for (const char c : name)
    if (c != '"' && c != '\\' && static_cast<unsigned char>(c) >= ' ' && static_cast<unsigned char>(c) < 0x80)
      text += c;
  return text + "\"";
}

// The binary chunk, and the accessors that describe it.
class Arrays {
 public:
  // Returns the index of the accessor.
  int add(const std::vector<float>& numbers, int components) {
    std::string range;
    for (const bool is_max : {false, true}) {
      range += is_max ? ",\"max\":[" : ",\"min\":[";
      for (int c = 0; c < components; ++c) {
        float limit = numbers.empty() ? 0 : numbers[c];
        for (size_t i = c; i < numbers.size(); i += components)
          limit = is_max ? std::max(limit, numbers[i]) : std::min(limit, numbers[i]);
        if (c > 0) range += ',';
        append_number(range, limit);
      }
      range += ']';
    }
    return add(numbers.data(), numbers.size(), components, kFloat, range);
  }
  int add(const std::vector<uint32_t>& indices) { return add(indices.data(), indices.size(), 1, kUnsignedInt, ""); }

  std::string json() const {
    return "\"accessors\":[" + accessors_ + "],\"bufferViews\":[" + views_ +
           "],\"buffers\":[{\"byteLength\":" + std::to_string(bytes_.size()) + "}]";
  }
  const std::string& bytes() const { return bytes_; }

 private:
  int add(const void* data, size_t count, int components, ComponentType type, const std::string& range) {
    const size_t size = 4 * count;
    const std::string comma = count_ == 0 ? "" : ",";
    views_ += comma + "{\"buffer\":0,\"byteOffset\":" + std::to_string(bytes_.size()) +
              ",\"byteLength\":" + std::to_string(size) + "}";
    accessors_ += comma + "{\"bufferView\":" + std::to_string(count_) + ",\"componentType\":" + std::to_string(type) +
                  ",\"count\":" + std::to_string(count / components) + ",\"type\":\"" +
                  (components == 3   ? "VEC3"
                   : components == 2 ? "VEC2"
                                     : "SCALAR") +
                  "\"" + range + "}";
    bytes_.append(static_cast<const char*>(data), size);
    return count_++;
  }

  std::string accessors_, views_, bytes_;
  int count_ = 0;
};

std::vector<uint32_t> corners(const GltfMesh& mesh) {
  std::vector<uint32_t> indices;
  for (const Segment& s : mesh.segments) indices.insert(indices.end(), s.begin(), s.end());
  if (mesh.segments.empty())
    for (const Triangle& t : mesh.triangles) indices.insert(indices.end(), t.begin(), t.end());
  return indices;
}

std::vector<float> difference(const std::vector<float>& a, const std::vector<float>& b) {
  std::vector<float> d(a.size());
  for (size_t i = 0; i < a.size(); ++i) d[i] = a[i] - b[i];
  return d;
}

// Frame k is the first frame plus target k - 1: at its time that weight is 1 and all others are 0.
std::vector<float> weights_of(size_t frames) {
  std::vector<float> weights(frames * (frames - 1), 0.0F);
  for (size_t k = 1; k < frames; ++k) weights[k * (frames - 1) + k - 1] = 1;
  return weights;
}

// The node of a camera, and the list of it.
struct CameraText {
  std::string node, list;

  CameraText() = default;
  explicit CameraText(const Camera& camera) {
    for (const auto& row : camera.matrix())
      for (const double number : row) {
        node += node.empty() ? ",{\"camera\":0,\"name\":\"view\",\"matrix\":[" : ",";
        append_number(node, number);
      }
    node += "]}";
    list = ",\"cameras\":[{\"type\":\"perspective\",\"perspective\":{\"yfov\":";
    append_number(list, 2 * std::atan(camera.slope));
    list += ",\"znear\":";
    append_number(list, camera.nearest);
    list += "}}]";
  }
};

std::string number(size_t index) { return std::to_string(index); }

// The nodes, meshes and the animation of all of them.
class SceneText {
 public:
  void add(const GltfMesh& mesh) {
    const std::string comma = count_ == 0 ? "" : ",", name = json_text(mesh.name);
    const std::string position = number(arrays_.add(mesh.frames[0], 3)), indices = number(arrays_.add(corners(mesh)));
    const std::string texture = mesh.uv.empty() ? "" : ",\"TEXCOORD_0\":" + number(arrays_.add(mesh.uv, 2));
    nodes_ += comma + "{\"mesh\":" + number(count_) + ",\"name\":" + name + "}";
    meshes_ += comma + "{\"name\":" + name + ",\"primitives\":[{\"attributes\":{\"POSITION\":" + position + texture +
               "},\"material\":0,\"indices\":" + indices + (mesh.segments.empty() ? "" : ",\"mode\":1") +
               targets(mesh) + "}]}";
    if (mesh.frames.size() > 1) moving_.push_back(count_);
    ++count_;
  }
  std::string json(const GltfScene& scene) {
    const CameraText camera = scene.camera ? CameraText(*scene.camera) : CameraText();
    std::string listed;
    for (size_t i = 0; i < count_ + (scene.camera ? 1 : 0); ++i) listed += (i > 0 ? "," : "") + number(i);
    const std::string animations = animation(scene.times);
    return R"({"asset":{"version":"2.0","generator":"Aspic"},"materials":[{"doubleSided":true}],)"
           R"("scene":0,"scenes":[{"nodes":[)" +
           listed + R"(]}],"nodes":[)" + nodes_ + camera.node + "]" + camera.list + ",\"meshes\":[" + meshes_ + "]" +
           animations + "," + arrays_.json() + "}";
  }
  const std::string& bytes() const { return arrays_.bytes(); }

 private:
  std::string targets(const GltfMesh& mesh) {
    std::string list;
    for (size_t k = 1; k < mesh.frames.size(); ++k)
      list += std::string(k > 1 ? "," : "") +
              "{\"POSITION\":" + number(arrays_.add(difference(mesh.frames[k], mesh.frames[0]), 3)) + "}";
    return list.empty() ? "" : ",\"targets\":[" + list + "]";
  }
  std::string animation(const std::vector<double>& times) {
    if (moving_.empty()) return "";
    std::string channels;
    for (const size_t node : moving_)
      channels += (channels.empty() ? "" : ",") + std::string("{\"sampler\":0,\"target\":{\"node\":") + number(node) +
                  ",\"path\":\"weights\"}}";
    const std::string input = number(arrays_.add(std::vector<float>(times.begin(), times.end()), 1));
    const std::string output = number(arrays_.add(weights_of(times.size()), 1));
    return ",\"animations\":[{\"channels\":[" + channels + "],\"samplers\":[{\"input\":" + input +
           ",\"output\":" + output + ",\"interpolation\":\"LINEAR\"}]}]";
  }

  Arrays arrays_;
  std::string nodes_, meshes_;
  std::vector<size_t> moving_;
  size_t count_ = 0;
};

void append_chunk(std::string& file, ChunkType type, std::string bytes, char filler) {
  bytes.resize((bytes.size() + 3) / 4 * 4, filler);
  append_word(file, static_cast<uint32_t>(bytes.size()));
  append_word(file, type);
  file += bytes;
}

}  // namespace

std::string glb(const GltfScene& scene) {
  SceneText text;
  for (const GltfMesh& mesh : scene.meshes) {
    ASPIC_CHECK(!mesh.frames.empty() && (mesh.frames.size() == 1 || mesh.frames.size() == scene.times.size()));
    text.add(mesh);
  }
  const std::string json = text.json(scene);
  std::string chunks;
  append_chunk(chunks, kJson, json, ' ');
  append_chunk(chunks, kBinary, text.bytes(), '\0');
  std::string file = "glTF";
  append_word(file, 2);
  append_word(file, static_cast<uint32_t>(12 + chunks.size()));
  return file + chunks;
}

}  // namespace aspic
