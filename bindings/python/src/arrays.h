// Arrays between Python and the library. Results are copies, so that no array outlives its memory.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <span>
#include <string>
#include <vector>

#include "math/small.h"
#include "mesh/numbering.h"

namespace aspic::python {

namespace py = pybind11;
using Array = py::array_t<double, py::array::c_style>;
using Shape = std::vector<py::ssize_t>;  // -1: any extent

enum class Finite { required, not_required };

// Throws InvalidInput if copies of a broadcast array need far more memory than the array.
void require_bounded(const py::array& array, const std::string& name);
// Returns the argument `name` as an array of doubles. Throws InvalidInput, in one line, unless it holds real numbers of
// this shape that are finite.
Array reals(const py::handle& value, const std::string& name, const Shape& shape, Finite finite = Finite::required);
// The same for integers in [0, limit).
std::vector<int> indices(const py::handle& value, const std::string& name, const Shape& shape, py::ssize_t limit);

std::span<const double> view(const Array& array);
Shape shape_of(const py::array& array);
py::ssize_t size_of(const Shape& shape);
std::string text_of(const Shape& shape);  // "(125, 3)"

Array to_array(std::span<const double> values, const Shape& shape);
py::array_t<int> to_array(std::span<const int> values, const Shape& shape);

std::vector<Vec3d> to_points(const Array& array);  // of shape (n, 3)
Array to_array(const std::vector<Vec3d>& points);  // of shape (n, 3)
Array to_array(const Vec3d& vector);               // of shape (3,)

// How the vector of an objective looks in Python: an array of this shape. Vectors of the library are in the order of
// the model and padded with zeros to 3 numbers per block row.
struct Layout {
  Shape shape;
  Renumbering vertex = {};  // of an array with a row per vertex

  static Layout of_vertices(const Renumbering& vertex, int count) { return {{count, 3}, vertex}; }
  py::ssize_t size() const { return size_of(shape); }
  int rows() const { return static_cast<int>((size() + 2) / 3); }
  // Accepts the shape itself and the flat array.
  std::vector<double> in(const py::handle& value, const std::string& name, Finite finite = Finite::required) const;
  Array out(std::span<const double> values) const;
};

}  // namespace aspic::python
