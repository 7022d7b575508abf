#include "viewer/picture.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace aspic::viewer {
namespace {

static_assert(std::endian::native == std::endian::little, "messages are little-endian");

constexpr uint32_t kGeometry = 1, kPicture = 2;
constexpr size_t kGeometryHeader = 32, kPictureHeader = 48;

// Writes values one after another into bytes of a known size.
class Writer {
 public:
  explicit Writer(size_t size) { bytes_.resize(size); }

  template <class T>
  void put(const T& value) {
    std::memcpy(bytes_.data() + at_, &value, sizeof value);
    at_ += sizeof value;
  }
  void skip_to(size_t at) { at_ = at; }
  void put_point(const Vec3d& x) {
    for (int r = 0; r < 3; ++r) put(static_cast<float>(x[r]));
  }
  std::string take() { return std::move(bytes_); }

 private:
  std::string bytes_;
  size_t at_ = 0;
};

int8_t component(double x) { return static_cast<int8_t>(std::lround(127 * std::clamp(x, -1.0, 1.0))); }

void put_normal(Writer& writer, const Vec3d& n) {
  const double size = norm(n);
  const bool is_known = size > 0 && std::isfinite(size);
  for (int r = 0; r < 3; ++r) writer.put(is_known ? component(n[r] / size) : int8_t{r == 2 ? int8_t{127} : int8_t{0}});
  writer.put(int8_t{0});
}

}  // namespace

std::string encode_geometry(const Stamp& stamp, const Surface& surface, const Numbering& numbering) {
  const size_t n = surface.rest.size(), m = surface.triangles.size(), e = surface.edges.size();
  Writer writer(kGeometryHeader + 4 * (3 * n + 3 * m + 2 * e + m + n));
  writer.put(kGeometry);
  writer.put(static_cast<uint32_t>(stamp.side));
  writer.put(stamp.generation);
  for (const size_t count : {n, m, e}) writer.put(static_cast<uint32_t>(count));
  writer.skip_to(kGeometryHeader);
  for (const Vec3d& X : surface.rest) writer.put_point(X);
  for (const Triangle& t : surface.triangles)
    for (const int v : t) writer.put(static_cast<uint32_t>(v));
  for (const auto& edge : surface.edges)
    for (const int v : edge) writer.put(static_cast<uint32_t>(v));
  for (const int t : surface.tet) writer.put(static_cast<uint32_t>(numbering.tet.to_user(t)));
  for (int v = 0; v < surface.vertex_count(); ++v) writer.put(surface.user_number(v, numbering));
  return writer.take();
}

std::string PictureEncoder::encode(const Stamp& stamp, const PictureOptions& options, const View& view,
                                   const Surface& surface) {
  const size_t n = surface.rest.size();
  const bool has_values = !options.field.empty();
  position_.resize(n);
  for (int v = 0; v < surface.vertex_count(); ++v) position_[v] = surface.position(v, view.x);
  normal_.assign(n, Vec3d{});
  for (const auto& [a, b, c] : surface.triangles) {
    const Vec3d twice_area = cross(position_[b] - position_[a], position_[c] - position_[a]);
    for (const int v : {a, b, c}) normal_[v] = normal_[v] + twice_area;
  }
  float smallest = 0, largest = 0;
  value_.resize(n);
  if (has_values) {
    fields_.evaluate(options.field, view, surface, value_);
    smallest = std::numeric_limits<float>::infinity(), largest = -smallest;
    for (const float value : value_)
      if (std::isfinite(value)) smallest = std::min(smallest, value), largest = std::max(largest, value);
    if (smallest > largest) smallest = largest = 0;  // no finite value
  }
  const std::vector<ContactPoint> contacts = contact_points(view);
  Writer writer(kPictureHeader + n * (has_values ? 20 : 16) + 16 * contacts.size());
  writer.put(kPicture);
  writer.put(static_cast<uint32_t>(stamp.side));
  writer.put(stamp.generation);
  writer.put(static_cast<uint32_t>(n));
  writer.put(static_cast<uint32_t>(options.step));
  writer.put(static_cast<int32_t>(options.iteration));
  writer.put(options.time);
  writer.put(static_cast<uint32_t>(has_values));
  writer.put(smallest);
  writer.put(largest);
  writer.put(static_cast<uint32_t>(contacts.size()));
  for (const Vec3d& x : position_) writer.put_point(x);
  for (const Vec3d& normal : normal_) put_normal(writer, normal);
  if (has_values)
    for (const float value : value_) writer.put(value);
  for (const ContactPoint& contact : contacts) {
    writer.put_point(contact.position);
    writer.put(static_cast<float>(contact.pressure));
  }
  return writer.take();
}

}  // namespace aspic::viewer
