// One run of gnuplot: data files and script in a temporary folder; the picture is moved to its destination.
#pragma once
#include <filesystem>
#include <string>
#include <string_view>

#include "aspic/plot.h"
#include "io/external_program.h"

namespace aspic::cli {

class Gnuplot {
 public:
  // Throws InvalidInput if the file name is neither .svg nor .png, or gnuplot is not installed.
  Gnuplot(const std::filesystem::path& picture, const PictureSize& size);

  void add(std::string_view commands) { script_ += commands, script_ += '\n'; }
  std::string data_file(const std::string& contents);  // returns the quoted name
  void draw();                                         // runs the script; writes the picture

 private:
  std::filesystem::path picture_, program_;
  TemporaryFolder folder_;
  std::string script_;
  int files_ = 0;
};

std::string literal(std::string_view text);  // string literal of gnuplot without special characters
// Returns "'text' noenhanced" for titles and labels.
std::string label(std::string_view text);
std::string number(double value);  // "NaN" if not finite, which gnuplot draws as a gap
std::string range(const std::optional<double>& min, const std::optional<double>& max);  // "[0:*]"
void append_row(std::string& text, std::initializer_list<double> values);

std::string color(int index);  // '#rrggbb', distinguishable for all kinds of color vision [Okabe and Ito 2008]
int mark(int index);           // filled circle, square, triangle, diamond, inverted triangle
inline constexpr const char* kInk = "#3a3a3a";
inline constexpr const char* kGrid = "#e2e2e2";

}  // namespace aspic::cli
