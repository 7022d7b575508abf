// Numbers of legacy VTK files, from text or big-endian binary.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "io/byte_cursor.h"
#include "io/text_scanner.h"
#include "io/vtu.h"

namespace aspic {

// Type of the numbers of an array.
struct LegacyVtkType {
  std::string_view name;
  size_t size;  // bytes in binary
  FieldType field = FieldType::float64;
  bool is_integer = true;
  double (*real)(ByteCursor&);
  int64_t (*integer)(ByteCursor&);  // null for floating-point numbers
};

const LegacyVtkType& legacy_vtk_int();    // of cells
const LegacyVtkType& legacy_vtk_color();  // of colors

// Reads words and arrays of a file alternately.
class LegacyVtkSource {
 public:
  LegacyVtkSource(const std::string& file, std::string_view contents)
      : text_(file, contents, TextScanner::kNoComments) {}

  TextScanner& text() { return text_; }
  void set_binary() { is_binary_ = true; }
  bool is_binary() const { return is_binary_; }

  const LegacyVtkType& type();  // reads the name of a type
  std::string name();           // reads the name of an array, whose blanks are written as %20
  // Read the numbers of an array, which begin on the next line. `count` may be any number.
  std::vector<double> reals(const LegacyVtkType& type, int64_t count);
  std::vector<int64_t> integers(const LegacyVtkType& type, int64_t count);
  void skip_texts(int64_t count);
  void skip_bits(int64_t count);

 private:
  template <class Number>
  std::vector<Number> numbers(const LegacyVtkType& type, int64_t count);

  TextScanner text_;
  bool is_binary_ = false;
};

std::string lower_case(std::string_view word);

}  // namespace aspic
