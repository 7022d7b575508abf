#include "io/gltf_file.h"

#include <algorithm>
#include <map>

#include "base/error.h"
#include "base/number_chars.h"
#include "base/printable.h"
#include "io/base64.h"
#include "io/byte_cursor.h"

namespace aspic {
namespace {

enum NumberType { kInt8 = 5120, kUint8, kInt16, kUint16, kUint32 = 5125, kFloat32 };
constexpr uint32_t kJsonChunk = 0x4e4f534a;       // type of a chunk
constexpr uint64_t kLargest = uint64_t{1} << 40;  // of an integer, so that products with a stride do not overflow
constexpr uint64_t kLargestStride = 252;

size_t size_of(uint64_t type) {
  return type == kInt8 || type == kUint8 ? 1 : type == kInt16 || type == kUint16 ? 2 : 4;
}

double read_number(ByteCursor& cursor, uint64_t type) {
  constexpr const char* kWhat = "a number of an accessor";
  switch (type) {
    case kInt8:
      return cursor.read<int8_t>(kWhat);
    case kUint8:
      return cursor.read<uint8_t>(kWhat);
    case kInt16:
      return cursor.read<int16_t>(kWhat);
    case kUint16:
      return cursor.read<uint16_t>(kWhat);
    case kUint32:
      return cursor.read<uint32_t>(kWhat);
    default:
      return cursor.read<float>(kWhat);
  }
}

// The integer of a normalized type that means 1.
double unit_of(uint64_t type) { return type == kInt8 ? 127 : type == kUint8 ? 255 : type == kInt16 ? 32767 : 65535; }

// An extension that changes neither triangles nor positions.
bool is_appearance(const std::string& extension) {
  for (const char* prefix : {"KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_"})
    if (extension.starts_with(prefix)) return true;
  return false;
}

// "my%20mesh.bin" -> "my mesh.bin"
std::string percent_decoded(std::string_view uri) {
  std::string name;
  for (size_t i = 0; i < uri.size(); ++i) {
    int code = 0;
    const char* digits = uri.data() + i + 1;
    const bool is_coded =
        uri[i] == '%' && i + 2 < uri.size() && from_chars(digits, digits + 2, code, 16).ptr == digits + 2;
    name += is_coded ? static_cast<char>(code) : uri[i];
    if (is_coded) i += 2;
  }
  return name;
}

std::string_view chunk(ByteCursor& bytes, std::string_view contents, uint32_t type) {
  const int size = bytes.checked_count(bytes.read<uint32_t>("the size of a chunk"), "the size of a chunk", 1);
  if (bytes.read<uint32_t>("the type of a chunk") != type) bytes.fail("the chunk has another type; export it again");
  const std::string_view part = contents.substr(bytes.position(), static_cast<size_t>(size));
  bytes.skip(static_cast<uint64_t>(size), "a chunk");
  return part;
}

}  // namespace

GltfFile::GltfFile(const std::string& file, std::string_view contents, const ReadBeside& read_beside) : file_(file) {
  open(contents);
  check_head();
  read_buffers(read_beside);
}

void GltfFile::fail(const std::string& message, const char* remedy) const {
  throw InvalidInput(file_ + ": byte " + std::to_string(json_at_) + ": " + message + "; " + remedy);
}

// Splits the file into its JSON and its binary part.
void GltfFile::open(std::string_view contents) {
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

void GltfFile::check_head() const {
  const Json* asset = member(root_, "asset");
  const Json* version = asset ? member(*asset, "version") : nullptr;
  if (!version || !version->is_string() || !version->get_ref<const std::string&>().starts_with("2."))
    fail("asset.version is not 2.x", "export it as glTF 2.0");
  for (const Json& extension : list(root_, "extensionsRequired"))
    if (!extension.is_string() || !is_appearance(extension.get_ref<const std::string&>()))
      fail(
          "it requires the extension " + (extension.is_string() ? shown(extension.get_ref<const std::string&>()) : "?"),
          "export it without compression and quantization");
}

const GltfFile::Json* GltfFile::member(const Json& object, const char* key) {
  if (!object.is_object()) return nullptr;
  const auto found = object.find(key);
  return found == object.end() ? nullptr : &*found;
}

const GltfFile::Json& GltfFile::list(const Json& object, const char* key) const {
  static const Json kEmpty = Json::array();
  const Json* found = member(object, key);
  if (found && !found->is_array()) fail(std::string(key) + " is no list");
  return found ? *found : kEmpty;
}

const GltfFile::Json& GltfFile::item(const char* key, uint64_t index) const {
  const Json& items = list(root_, key);
  if (index >= items.size()) fail(name(key, index) + " is named, but there are " + std::to_string(items.size()));
  return items[index];
}

const GltfFile::Json& GltfFile::scene() const { return item("scenes", integer(root_, "scene", "the file", 0)); }

uint64_t GltfFile::integer(const Json& object, const char* key, const std::string& owner,
                           std::optional<uint64_t> fallback) const {
  const Json* found = member(object, key);
  if (!found && fallback) return *fallback;
  if (!found || !found->is_number_unsigned()) fail(owner + " has no integer " + key);
  if (found->get<uint64_t>() > kLargest) fail(key + (" of " + owner) + " is out of range: " + found->dump());
  return found->get<uint64_t>();
}

void GltfFile::read_buffers(const ReadBeside& read_beside) {
  const Json& buffers = list(root_, "buffers");
  for (size_t i = 0; i < buffers.size(); ++i) {
    const std::string owner = name("buffers", i);
    const Json* uri = member(buffers[i], "uri");
    if (uri && !uri->is_string()) fail("uri of " + owner + " is no text");
    std::string bytes =
        uri ? bytes_of(uri->get_ref<const std::string&>(), owner, read_beside) : std::string(i == 0 ? binary_ : "");
    const uint64_t length = integer(buffers[i], "byteLength", owner);
    if (length > bytes.size())
      fail(owner + " should have " + std::to_string(length) + " bytes, but has " + std::to_string(bytes.size()));
    bytes.resize(length);
    budget_ += bytes.size();
    buffers_.push_back(std::move(bytes));
  }
}

std::string GltfFile::bytes_of(std::string_view uri, const std::string& owner, const ReadBeside& read_beside) const {
  if (!uri.starts_with("data:")) {
    const std::string name = percent_decoded(uri);
    if (name.empty() || name[0] == '/' || name.find("..") != name.npos || name.find_first_of(":\\") != name.npos ||
        name.find('\0') != name.npos)
      fail("uri of " + owner + " is no name of a file beside this one");
    return read_beside(name);
  }
  constexpr std::string_view kMark = ";base64,";
  const size_t mark = uri.find(kMark);
  std::string bytes;
  if (mark != uri.npos) uri.remove_prefix(mark + kMark.size());
  if (mark == uri.npos || !decode_base64(uri, SIZE_MAX, bytes)) fail("the data of " + owner + " are no Base64");
  return bytes;
}

std::string GltfFile::self_contained() const {
  Json root = root_;
  for (size_t i = 0; i < buffers_.size(); ++i) {
    std::string uri = "data:application/octet-stream;base64,";
    append_base64(buffers_[i], uri);
    root["buffers"][i]["uri"] = std::move(uri);
  }
  return root.dump();
}

GltfFile::View GltfFile::view(uint64_t index) const {
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

std::vector<double> GltfFile::values(uint64_t index, const char* shape, bool are_indices) {
  static const std::map<std::string_view, size_t> kComponents = {
      {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT4", 16}};
  const std::string owner = name("accessors", index);
  const Json& accessor = item("accessors", index);
  if (accessor.contains("sparse") || !accessor.contains("bufferView"))
    fail(owner + " is sparse or compressed", "export it without sparse accessors and compression");
  const Json *given = member(accessor, "type"), *normalized = member(accessor, "normalized");
  if (!given || *given != shape) fail(owner + " is no " + shape);
  const uint64_t type = integer(accessor, "componentType", owner), count = integer(accessor, "count", owner);
  const bool is_real = type == kFloat32 || (normalized && *normalized == true && type >= kInt8 && type <= kUint16);
  if (are_indices ? type != kUint8 && type != kUint16 && type != kUint32 : !is_real)
    fail(owner + " has components of type " + std::to_string(type), "export numbers as 32-bit floats");
  const View place = view(integer(accessor, "bufferView", owner));
  const uint64_t offset = integer(accessor, "byteOffset", owner, 0), components = kComponents.at(shape);
  const uint64_t size = components * size_of(type), stride = place.stride == 0 ? size : place.stride;
  if (stride < size || stride > kLargestStride) fail(owner + " has byteStride " + std::to_string(stride));
  if (count > 0 && offset + stride * (count - 1) + size > place.bytes.size())
    fail(owner + " ends beyond its bufferView of " + std::to_string(place.bytes.size()) + " bytes");
  if (count > budget_) fail("the nodes repeat meshes to too many vertices", "reduce the instances");
  budget_ -= count;
  std::vector<double> numbers;
  for (uint64_t i = 0; i < count; ++i) {
    ByteCursor cursor(file_, place.bytes, offset + i * stride);
    for (uint64_t c = 0; c < components; ++c) {
      const double number = read_number(cursor, type);
      if (!std::isfinite(number)) fail("element " + std::to_string(i) + " of " + owner + " is not finite");
      numbers.push_back(are_indices || type == kFloat32 ? number : std::max(number / unit_of(type), -1.0));
    }
  }
  return numbers;
}

}  // namespace aspic
