#include "aspic/gnuplot.h"

#include <fmt/format.h>

#include <cmath>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/number_text.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

std::string terminal(const fs::path& picture, const PictureSize& size) {
  if (picture.extension() == ".svg")
    return fmt::format("set terminal svg size {},{} enhanced font 'Helvetica,14' background '#ffffff'", size.width,
                       size.height);
  if (picture.extension() == ".png")
    return fmt::format("set terminal pngcairo size {},{} enhanced font 'Sans,11' fontscale 2 linewidth 2 pointscale 2",
                       2 * size.width, 2 * size.height);
  throw InvalidInput(
      fmt::format("{}: a picture must be .svg or .png, not '{}'", picture.string(), picture.extension().string()));
}

fs::path find_gnuplot() {
  return find_program("gnuplot", {},
                      "pictures need it; install the Debian package gnuplot-nox (apt-get install "
                      "--no-install-recommends gnuplot-nox)");
}

}  // namespace

void require_drawable(const fs::path& picture) {
  terminal(picture, {});
  find_gnuplot();
}

Gnuplot::Gnuplot(const fs::path& picture, const PictureSize& size)
    : picture_(picture), program_(find_gnuplot()), script_("set encoding utf8\n" + terminal(picture, size) + '\n') {
  add("apostrophe = \"'\"");
  add(fmt::format("set output {}", literal((folder_.path() / "picture").string())));
  add(fmt::format("set border 3 lc rgb '{0}' lw 0.8\nset tics nomirror scale 0.5 textcolor rgb '{0}'", kInk));
  add(
      fmt::format("set title textcolor rgb '{0}'\nset xlabel textcolor rgb '{0}'\nset ylabel textcolor rgb '{0}'\n"
                  "set zlabel textcolor rgb '{0}'\nset key textcolor rgb '{0}'",
                  kInk));
  add("set key below center horizontal Left reverse samplen 2 width 1 maxrows 3 height 1");
}

std::string Gnuplot::data_file(const std::string& contents) {
  const fs::path path = folder_.path() / fmt::format("data{}", files_++);
  write_file(path, contents);
  return literal(path.string());
}

void Gnuplot::draw() {
  const fs::path script = folder_.path() / "script", drawn = folder_.path() / "picture";
  write_file(script, script_ + "set output\n");
  const std::string said = run_program({.name = "gnuplot",
                                        .command = {program_.string(), "-d", script.string()},
                                        .about = picture_.string(),
                                        .messages = folder_.path() / "messages",
                                        .after_signal = "out of memory?",
                                        .when_unusable = "install the Debian package gnuplot-nox"});
  std::error_code error;
  if (!fs::exists(drawn, error))
    throw InvalidInput(fmt::format("{}: gnuplot drew nothing: {}", picture_.string(), said));
  write_file(picture_, read_file(drawn));
}

std::string literal(std::string_view text) {
  // Within single quotes only the quote is special. Doubled it represents itself, except at the beginning or next to
  // another one; there a variable is concatenated.
  std::string result = "'";
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool alone = i > 0 && text[i - 1] != '\'' && (i + 1 == text.size() || text[i + 1] != '\'');
    if (c == '\'')
      result += alone ? "''" : "' . apostrophe . '";
    else
      result += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? ' ' : c;
  }
  return result + '\'';
}

std::string label(std::string_view text) { return literal(text) + " noenhanced"; }

std::string number(double value) {
  if (!std::isfinite(value)) return "NaN";
  std::string text;
  append_number(text, value);
  return text;
}

std::string range(const std::optional<double>& min, const std::optional<double>& max) {
  return fmt::format("[{}:{}]", min ? number(*min) : "*", max ? number(*max) : "*");
}

void append_row(std::string& text, std::initializer_list<double> values) {
  for (const double value : values) text += number(value) + ' ';
  text.back() = '\n';
}

std::string color(int index) {
  static constexpr const char* kColors[] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                            "#e69f00", "#56b4e9", "#555555"};
  return fmt::format("'{}'", kColors[static_cast<size_t>(index) % std::size(kColors)]);
}

int mark(int index) {
  static constexpr int kMarks[] = {7, 5, 9, 13, 11};
  return kMarks[static_cast<size_t>(index) % std::size(kMarks)];
}

}  // namespace aspic::cli
