#include "arrays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "scene/value.h"

namespace aspic::python {
namespace {

constexpr double kMostRepeated = 3e7;  // numbers of an array that has fewer in memory

std::string type_of(const py::handle& value) { return py::str(py::type::of(value).attr("__name__")); }

py::array array_of(const py::handle& value, const std::string& name, const char* expected) {
  py::array array = py::array::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw InvalidInput(name + ": this is " + type_of(value) + "; expected " + expected);
  }
  return array;
}

bool fits(const Shape& found, const Shape& expected) {
  return std::equal(found.begin(), found.end(), expected.begin(), expected.end(),
                    [](py::ssize_t a, py::ssize_t b) { return b < 0 || a == b; });
}

void require_shape(const py::array& array, const std::string& name, const Shape& expected) {
  const Shape found = shape_of(array);
  if (!fits(found, expected))
    throw InvalidInput(name + ": shape " + text_of(found) + "; expected " + text_of(expected));
}

// "[3, 1]"
std::string place_of(py::ssize_t index, const Shape& shape) {
  std::string text;
  for (size_t axis = shape.size(); axis-- > 0;) {
    text.insert(0, std::to_string(index % shape[axis]) + (text.empty() ? "" : ", "));
    index /= shape[axis];
  }
  return text.empty() ? "" : "[" + text + "]";
}

}  // namespace

Shape shape_of(const py::array& array) { return {array.shape(), array.shape() + array.ndim()}; }

py::ssize_t size_of(const Shape& shape) {
  py::ssize_t size = 1;
  for (const py::ssize_t extent : shape) size *= extent;
  return size;
}

std::string text_of(const Shape& shape) {
  std::string text;
  for (const py::ssize_t extent : shape)
    text += (text.empty() ? "" : ", ") + (extent < 0 ? "n" : std::to_string(extent));
  return "(" + text + (shape.size() == 1 ? ",)" : ")");
}

std::span<const double> view(const Array& array) { return {array.data(), static_cast<size_t>(array.size())}; }

void require_bounded(const py::array& array, const std::string& name) {
  double size = 1, bytes = static_cast<double>(array.itemsize());
  for (py::ssize_t axis = 0; axis < array.ndim(); ++axis) {
    size *= static_cast<double>(array.shape(axis));
    bytes += static_cast<double>(array.shape(axis) - 1) * std::abs(static_cast<double>(array.strides(axis)));
  }
  if (size > kMostRepeated && size * static_cast<double>(array.itemsize()) > bytes)
    throw InvalidInput(name + ": shape " + text_of(shape_of(array)) +
                       " of an array that repeats numbers, as by broadcasting; at most " + number_text(kMostRepeated) +
                       " are accepted");
}

Array reals(const py::handle& value, const std::string& name, const Shape& shape, Finite finite) {
  const py::array array = array_of(value, name, "an array of numbers");
  if (std::string("fiu").find(array.dtype().kind()) == std::string::npos)
    throw InvalidInput(name + ": dtype " + std::string(py::str(array.dtype())) + "; expected real numbers");
  require_shape(array, name, shape);
  require_bounded(array, name);
  const auto numbers = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!numbers) throw py::error_already_set();
  const auto begin = numbers.data(), end = begin + numbers.size();
  const auto bad = std::find_if(begin, end, [](double x) { return !std::isfinite(x); });
  if (finite == Finite::required && bad != end)
    throw InvalidInput(name + place_of(bad - begin, shape_of(numbers)) + " = " + number_text(*bad) +
                       "; must be finite");
  return Array(numbers);
}

std::vector<int> indices(const py::handle& value, const std::string& name, const Shape& shape, py::ssize_t limit) {
  const py::array array = array_of(value, name, "an array of integers");
  const bool is_empty = array.size() == 0;  // whose dtype is that of floats
  if (!is_empty && array.dtype().kind() != 'i' && array.dtype().kind() != 'u')
    throw InvalidInput(name + ": dtype " + std::string(py::str(array.dtype())) + "; expected integers, as of " + name +
                       ".astype(int)");
  require_shape(array, name, shape);
  require_bounded(array, name);
  const auto numbers = py::array_t<int64_t, py::array::c_style | py::array::forcecast>::ensure(array);
  if (!numbers) throw py::error_already_set();
  std::vector<int> result;
  result.reserve(static_cast<size_t>(numbers.size()));
  for (py::ssize_t i = 0; i < numbers.size(); ++i) {
    const int64_t index = numbers.data()[i];
    if (index < 0 || index >= limit)
      throw InvalidInput(name + place_of(i, shape_of(numbers)) + " = " + std::to_string(index) +
                         "; must be at least 0 and below " + std::to_string(limit) +
                         (index == limit ? ", because numbers begin with 0" : ""));
    result.push_back(static_cast<int>(index));
  }
  return result;
}

Array to_array(std::span<const double> values, const Shape& shape) {
  Array array(shape);
  std::copy_n(values.begin(), array.size(), array.mutable_data());
  return array;
}

py::array_t<int> to_array(std::span<const int> values, const Shape& shape) {
  py::array_t<int> array(shape);
  std::copy_n(values.begin(), array.size(), array.mutable_data());
  return array;
}

std::vector<Vec3d> to_points(const Array& array) {
  std::vector<Vec3d> points(static_cast<size_t>(array.shape(0)));
  for (size_t i = 0; i < points.size(); ++i)
    for (int r = 0; r < 3; ++r) points[i][r] = array.data()[3 * i + static_cast<size_t>(r)];
  return points;
}

Array to_array(const std::vector<Vec3d>& points) {
  Array array({static_cast<py::ssize_t>(points.size()), py::ssize_t{3}});
  for (size_t i = 0; i < points.size(); ++i)
    for (int r = 0; r < 3; ++r) array.mutable_data()[3 * i + static_cast<size_t>(r)] = points[i][r];
  return array;
}

Array to_array(const Vec3d& vector) {
  Array array(Shape{3});
  for (int r = 0; r < 3; ++r) array.mutable_data()[r] = vector[r];
  return array;
}

std::vector<double> Layout::in(const py::handle& value, const std::string& name, Finite finite) const {
  const py::array array = array_of(value, name, "an array of numbers");
  const bool is_flat = array.ndim() == 1 && array.size() == size();
  const Array numbers = reals(array, name, is_flat ? Shape{size()} : shape, finite);
  std::vector<double> x = vertex.is_identity() ? std::vector<double>(view(numbers).begin(), view(numbers).end())
                                               : vertex.from_user(view(numbers), 3);
  x.resize(3 * static_cast<size_t>(rows()));
  return x;
}

Array Layout::out(std::span<const double> values) const {
  if (vertex.is_identity()) return to_array(values, shape);
  return to_array(vertex.to_user(values, 3), shape);
}

}  // namespace aspic::python
