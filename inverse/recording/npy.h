// Arrays in numpy's format NPY [NEP 1].
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace aspic {

struct NpyArray {
  std::vector<size_t> shape;
  std::vector<double> numbers;     // in C order, for floating-point and integer arrays
  std::vector<std::string> texts;  // for arrays of texts
};

// Throws InvalidInput for damaged files and other types. `file`: name for messages.
NpyArray parse_npy(const std::string& file, std::string_view contents);

}  // namespace aspic
