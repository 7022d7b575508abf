// A report as a self-contained HTML file with embedded pictures. Escapes text.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::cli {

enum class Verdict { pass, fail, neutral };

struct Cell {
  std::string text;
  std::optional<Verdict> verdict = {};  // badge around the text
};

struct Figure {
  std::filesystem::path picture;  // .svg or .png; read when it is added
  std::string caption;
};

class ReportPage {
 public:
  explicit ReportPage(std::string_view title, std::string_view subtitle = "");

  void heading(std::string_view text);  // also an entry of the table of contents
  void paragraph(std::string_view text);
  void formula(std::string_view mathml);  // inserted unchanged
  void code(std::string_view text);       // a command or a formula
  void verdict(Verdict verdict, std::string_view label, std::string_view text);
  void table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows);
  void figures(const std::vector<Figure>& row);  // side by side if the width allows; throws InvalidInput

  std::string html() const;
  void write(const std::filesystem::path& path) const;  // throws InvalidInput

 private:
  std::string title_, subtitle_, contents_, body_;
  int headings_ = 0, pictures_ = 0;
};

}  // namespace aspic::cli
