#include "io/gltf_reader.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>

#include "base/error.h"
#include "base/printable.h"
#include "io/base64.h"
#include "io/byte_cursor.h"
#include "io/vertex_merger.h"

namespace aspic {
namespace {

using Json = nlohmann::json;

enum NumberType { kUint8 = 5121, kUint16 = 5123, kUint32 = 5125, kFloat32 = 5126 };
constexpr uint64_t kTriangles = 4;                // mode of a primitive
constexpr uint32_t kJsonChunk = 0x4e4f534a;       // type of a chunk
constexpr uint64_t kLargest = uint64_t{1} << 40;  // of an integer, so that products with a stride do not overflow
constexpr uint64_t kLargestStride = 252;
constexpr uint64_t kMostRepeated = uint64_t{1} << 22;  // vertices and corners of meshes that several nodes repeat

// x -> linear x + translation
struct Placement {
  Mat3d linear = identity3<double>();
  Vec3d translation = {};
};

Placement operator*(const Placement& outer, const Placement& inner) {
  return {outer.linear * inner.linear, outer.linear * inner.translation + outer.translation};
}

Mat3d rotation(const double* q) {
  const auto [x, y, z, w] = std::array<double, 4>{q[0], q[1], q[2], q[3]};
  return {{1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w),  //
           2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w),  //
           2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)}};
}

// An extension that changes neither triangles nor positions.
bool is_appearance(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_"})
    if (extension.starts_with(prefix)) return true;
  return false;
}

class GltfReader {
 public:
  GltfReader(const std::string& file, std::string_view contents, const ReadBeside& read_beside)
      : file_(file), read_beside_(read_beside) {
    open(contents);
  }

  MeshContent read() {
    check_head();
    read_buffers();
    const Json& scene = item("scenes", integer(root_, "scene", "the file", 0));
    visited_.resize(list(root_, "nodes").size());
    std::vector<std::pair<uint64_t, Placement>> pending;
    add_nodes(list(scene, "nodes"), {}, pending);
    while (!pending.empty()) {
      const auto [index, parent] = pending.back();
      pending.pop_back();
      const Json& node = item("nodes", index);
      if (std::exchange(visited_[index], 1)) fail(name("nodes", index) + " has two parents");
      const Placement placement = parent * placement_of(node, name("nodes", index));
      if (node.contains("mesh"))
        add_mesh(integer(node, "mesh", "a node"), node.contains("skin") ? Placement{} : placement);
      add_nodes(list(node, "children"), placement, pending);
    }
    return std::move(content_);
  }

 private:
  static std::string name(const char* what, uint64_t index) {
    return std::string(what) + "[" + std::to_string(index) + "]";
  }

  [[noreturn]] void fail(const std::string& message,
                         const char* remedy = "export it again, or get a complete copy") const {
    throw InvalidInput(file_ + ": byte " + std::to_string(json_at_) + ": " + message + "; " + remedy);
  }

  // Splits the file into its JSON and its binary part.
  void open(std::string_view contents) {
    std::string_view text = contents;
    if (contents.starts_with("glTF")) {
      ByteCursor bytes(file_, contents, 4);
      if (const auto version = bytes.read<uint32_t>("the version"); version != 2)
        bytes.fail("this is glTF " + std::to_string(version) + ", only glTF 2 is read; export it again");
      bytes.skip(4, "the length of the file");
      text = chunk(bytes, contents, kJsonChunk);
      json_at_ = static_cast<size_t>(text.data() - contents.data());
      if (bytes.remaining() > 0) binary_ = chunk(bytes, contents, 0x004e4942);
    }
    try {
      root_ = Json::parse(text);
    } catch (const Json::exception&) {
      fail("the file is no JSON, or is cut short");
    }
    if (!root_.is_object()) fail("the JSON is no object");
  }

  static std::string_view chunk(ByteCursor& bytes, std::string_view contents, uint32_t type) {
    const int size = bytes.checked_count(bytes.read<uint32_t>("the size of a chunk"), "the size of a chunk", 1);
    if (bytes.read<uint32_t>("the type of a chunk") != type) bytes.fail("the chunk has another type; export it again");
    const std::string_view part = contents.substr(bytes.position(), static_cast<size_t>(size));
    bytes.skip(static_cast<uint64_t>(size), "a chunk");
    return part;
  }

  void check_head() const {
    const Json* asset = member(root_, "asset");
    const Json* version = asset ? member(*asset, "version") : nullptr;
    if (!version || !version->is_string() || !version->get_ref<const std::string&>().starts_with("2."))
      fail("asset.version is not 2.x", "export it as glTF 2.0");
    for (const Json& extension : list(root_, "extensionsRequired"))
      if (!extension.is_string() || !is_appearance(extension.get_ref<const std::string&>()))
        fail("it requires the extension " +
                 (extension.is_string() ? shown(extension.get_ref<const std::string&>()) : "?"),
             "export it without compression and quantization");
  }

  static const Json* member(const Json& object, const char* key) {
    if (!object.is_object()) return nullptr;
    const auto found = object.find(key);
    return found == object.end() ? nullptr : &*found;
  }

  const Json& list(const Json& object, const char* key) const {
    static const Json kEmpty = Json::array();
    const Json* found = member(object, key);
    if (found && !found->is_array()) fail(std::string(key) + " is no list");
    return found ? *found : kEmpty;
  }

  const Json& item(const char* key, uint64_t index) const {
    const Json& items = list(root_, key);
    if (index >= items.size()) fail(name(key, index) + " is named, but there are " + std::to_string(items.size()));
    return items[index];
  }

  uint64_t integer(const Json& object, const char* key, const std::string& owner,
                   std::optional<uint64_t> fallback = std::nullopt) const {
    const Json* found = member(object, key);
    if (!found && fallback) return *fallback;
    if (!found || !found->is_number_unsigned()) fail(owner + " has no integer " + key);
    if (found->get<uint64_t>() > kLargest) fail(key + (" of " + owner) + " is out of range: " + found->dump());
    return found->get<uint64_t>();
  }

  template <size_t n>
  std::array<double, n> numbers(const Json& node, const char* key, std::array<double, n> fallback) const {
    const Json& given = list(node, key);
    if (given.empty()) return fallback;
    if (given.size() != n) fail(std::string(key) + " of a node has " + std::to_string(given.size()) + " numbers");
    for (size_t i = 0; i < n; ++i) {
      if (!given[i].is_number() || !std::isfinite(given[i].get<double>()))
        fail(std::string(key) + " of a node has no number");
      fallback[i] = given[i].get<double>();
    }
    return fallback;
  }

  Placement placement_of(const Json& node, const std::string& owner) const {
    if (node.contains("matrix")) {
      const auto m = numbers<16>(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1) fail("matrix of " + owner + " is not affine");
      return {{{m[0], m[1], m[2], m[4], m[5], m[6], m[8], m[9], m[10]}}, {{m[12], m[13], m[14]}}};
    }
    const auto t = numbers<3>(node, "translation", {0, 0, 0}), s = numbers<3>(node, "scale", {1, 1, 1});
    Mat3d linear = rotation(numbers<4>(node, "rotation", {0, 0, 0, 1}).data());
    for (int r = 0; r < 3; ++r)
      for (int c = 0; c < 3; ++c) linear(r, c) *= s[static_cast<size_t>(c)];
    return {linear, {{t[0], t[1], t[2]}}};
  }

  void add_nodes(const Json& nodes, const Placement& parent,
                 std::vector<std::pair<uint64_t, Placement>>& pending) const {
    for (const Json& node : nodes) {
      if (!node.is_number_unsigned() || node.get<uint64_t>() >= visited_.size())
        fail("a list of nodes names none of the " + std::to_string(visited_.size()));
      pending.emplace_back(node.get<uint64_t>(), parent);
    }
    if (pending.size() > visited_.size()) fail("a node has two parents");
  }

  void read_buffers() {
    const Json& buffers = list(root_, "buffers");
    for (size_t i = 0; i < buffers.size(); ++i) {
      const std::string owner = name("buffers", i);
      const Json* uri = member(buffers[i], "uri");
      if (uri && !uri->is_string()) fail("uri of " + owner + " is no text");
      std::string bytes =
          uri ? bytes_of(uri->get_ref<const std::string&>(), owner) : std::string(i == 0 ? binary_ : "");
      const uint64_t length = integer(buffers[i], "byteLength", owner);
      if (length > bytes.size())
        fail(owner + " should have " + std::to_string(length) + " bytes, but has " + std::to_string(bytes.size()));
      bytes.resize(length);
      budget_ += bytes.size();
      buffers_.push_back(std::move(bytes));
    }
  }

  std::string bytes_of(std::string_view uri, const std::string& owner) const {
    if (!uri.starts_with("data:")) {
      if (uri.empty() || uri[0] == '/' || uri.find("..") != uri.npos || uri.find_first_of(":\\") != uri.npos ||
          uri.find('\0') != uri.npos)
        fail("uri of " + owner + " is no name of a file beside this one");
      return read_beside_(std::string(uri));
    }
    constexpr std::string_view kMark = ";base64,";
    const size_t mark = uri.find(kMark);
    std::string bytes;
    if (mark != uri.npos) uri.remove_prefix(mark + kMark.size());
    if (mark == uri.npos || !decode_base64(uri, SIZE_MAX, bytes)) fail("the data of " + owner + " are no Base64");
    return bytes;
  }

  struct View {
    std::string_view bytes;
    uint64_t stride;  // 0: the elements follow each other
  };

  View view(uint64_t index) const {
    const std::string owner = name("bufferViews", index);
    const Json& view = item("bufferViews", index);
    const auto buffer = integer(view, "buffer", owner);
    if (buffer >= buffers_.size()) fail(owner + " names a missing buffer");
    const std::string_view bytes = buffers_[buffer];
    const uint64_t offset = integer(view, "byteOffset", owner, 0), length = integer(view, "byteLength", owner);
    if (offset + length > bytes.size())
      fail(owner + " ends beyond its buffer of " + std::to_string(bytes.size()) + " bytes");
    return {bytes.substr(offset, length), integer(view, "byteStride", owner, 0)};
  }

  // Elements of an accessor whose size and place are checked.
  struct Elements {
    std::string_view bytes;
    uint64_t stride, count, type;
  };

  Elements elements(uint64_t index, const char* shape, size_t components) {
    const std::string owner = name("accessors", index);
    const Json& accessor = item("accessors", index);
    if (accessor.contains("sparse") || !accessor.contains("bufferView"))
      fail(owner + " is sparse or compressed", "export it without sparse accessors and compression");
    const Json* given = member(accessor, "type");
    if (!given || *given != shape) fail(owner + " is no " + shape);
    const uint64_t type = integer(accessor, "componentType", owner), count = integer(accessor, "count", owner);
    if (components == 3 ? type != kFloat32 : type != kUint8 && type != kUint16 && type != kUint32)
      fail(owner + " has components of type " + std::to_string(type), "export positions as 32-bit floats");
    const auto [bytes, given_stride] = view(integer(accessor, "bufferView", owner));
    const uint64_t offset = integer(accessor, "byteOffset", owner, 0);
    const uint64_t size = components * (type == kUint8 ? 1 : type == kUint16 ? 2 : 4);
    const uint64_t stride = given_stride == 0 ? size : given_stride;
    if (stride < size || stride > kLargestStride) fail(owner + " has byteStride " + std::to_string(stride));
    if (count > 0 && offset + stride * (count - 1) + size > bytes.size())
      fail(owner + " ends beyond its bufferView of " + std::to_string(bytes.size()) + " bytes");
    if (count > budget_) fail("the nodes repeat meshes to too many vertices", "reduce the instances");
    budget_ -= count;
    return {bytes.substr(std::min<uint64_t>(offset, bytes.size())), stride, count, type};
  }

  void add_mesh(uint64_t index, const Placement& placement) {
    VertexMerger merger;
    for (const Json& primitive : list(item("meshes", index), "primitives")) {
      const uint64_t mode = integer(primitive, "mode", "a primitive", kTriangles);
      if (mode < kTriangles) continue;  // points and lines
      if (mode > kTriangles) fail(name("meshes", index) + " has strips or fans", "triangulate it");
      const Json* attributes = member(primitive, "attributes");
      if (!attributes) fail(name("meshes", index) + " has no attributes");
      const std::vector<int> vertices =
          add_vertices(integer(*attributes, "POSITION", name("meshes", index)), placement, merger);
      add_triangles(primitive, vertices, determinant(placement.linear) < 0);
    }
  }

  // Returns the merged index of each vertex.
  std::vector<int> add_vertices(uint64_t accessor, const Placement& placement, VertexMerger& merger) {
    const Elements points = elements(accessor, "VEC3", 3);
    std::vector<int> vertices;
    for (size_t i = 0; i < points.count; ++i) {
      ByteCursor cursor(file_, points.bytes, i * points.stride);
      Vec3d x;
      for (double& coordinate : x.a) coordinate = cursor.read<float>("a position");
      x = placement.linear * x + placement.translation;
      for (const double coordinate : x.a)
        if (!std::isfinite(coordinate))
          fail("vertex " + std::to_string(i) + " of " + name("accessors", accessor) + " is not finite");
      vertices.push_back(merger.vertex(x, content_.vertices));
    }
    return vertices;
  }

  void add_triangles(const Json& primitive, const std::vector<int>& vertices, bool is_mirrored) {
    std::vector<int> corners = vertices;
    if (primitive.contains("indices")) {
      const uint64_t accessor = integer(primitive, "indices", "a primitive");
      const Elements indices = elements(accessor, "SCALAR", 1);
      corners.clear();
      for (size_t i = 0; i < indices.count; ++i) {
        ByteCursor cursor(file_, indices.bytes, i * indices.stride);
        const uint32_t corner = indices.type == kUint8    ? cursor.read<uint8_t>("an index")
                                : indices.type == kUint16 ? cursor.read<uint16_t>("an index")
                                                          : cursor.read<uint32_t>("an index");
        if (corner >= vertices.size())
          fail(name("accessors", accessor) + " names vertex " + std::to_string(corner) + " of " +
               std::to_string(vertices.size()));
        corners.push_back(vertices[corner]);
      }
    }
    if (is_mirrored)
      for (size_t i = 2; i < corners.size(); i += 3) std::swap(corners[i - 1], corners[i]);
    if (corners.size() % 3 != 0) fail("the corners of a mesh are no multiple of 3");
    for (size_t i = 0; i < corners.size(); i += 3)
      content_.triangles.push_back({corners[i], corners[i + 1], corners[i + 2]});
  }

  std::string file_;
  const ReadBeside& read_beside_;
  Json root_;
  size_t json_at_ = 0;
  std::string_view binary_;
  std::vector<std::string> buffers_;
  std::vector<char> visited_;  // nodes
  MeshContent content_;
  uint64_t budget_ = kMostRepeated;  // vertices and corners that may follow
};

}  // namespace

MeshContent parse_gltf(const std::string& file, std::string_view contents, const ReadBeside& read_beside) {
  return GltfReader(file, contents, read_beside).read();
}

}  // namespace aspic
