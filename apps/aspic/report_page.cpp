#include "aspic/report_page.h"

#include <fmt/format.h>

#include <cctype>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/base64.h"

namespace aspic::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; }
body { margin: 0 auto; max-width: 62rem; padding: 2.5rem 1.5rem 5rem; color: #222; background: #fff;
  font: 1rem/1.55 system-ui, -apple-system, "Segoe UI", "Helvetica Neue", Arial, sans-serif; }
h1 { font-size: 1.9rem; line-height: 1.2; margin: 0 0 .3rem; }
h2 { font-size: 1.3rem; margin: 2.8rem 0 .6rem; padding-top: .8rem; border-top: 1px solid #e4e4e4; }
p { margin: .6rem 0; max-width: 46rem; }
.subtitle { color: #666; }
nav ol { columns: 20rem auto; padding-left: 1.4rem; color: #777; }
a { color: #0063a0; text-decoration: none; } a:hover { text-decoration: underline; }
pre { background: #f6f7f8; border: 1px solid #e8e8e8; border-radius: 4px; padding: .6rem .8rem; overflow-x: auto;
  font: .88rem/1.45 ui-monospace, SFMono-Regular, Menlo, Consolas, "DejaVu Sans Mono", monospace; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 1rem 0; font-size: .93rem; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; border-bottom: 2px solid #bbb; padding: .3rem .9rem .3rem 0; }
td { border-bottom: 1px solid #ececec; padding: .3rem .9rem .3rem 0; vertical-align: top; }
td.number, th.number { text-align: right; }
td.number, td.short { white-space: nowrap; }
td:not([class]) { min-width: 12rem; }
.badge { display: inline-block; border-radius: 3px; padding: 0 .45em; font-size: .85em; font-weight: 600;
  white-space: nowrap; }
.pass { background: #d9efe6; color: #00573f; } .pass::before { content: "\2713\00a0"; }
.fail { background: #f9dfd0; color: #8c3200; } .fail::before { content: "\2717\00a0"; }
.neutral { background: #ececec; color: #444; }
.figures { display: flex; flex-wrap: wrap; gap: 1rem 1.5rem; margin: 1rem 0; }
figure { margin: 0; flex: 1 1 22rem; min-width: 0; }
figure svg, figure img { display: block; max-width: 100%; height: auto; margin: 0 auto; }
figcaption { color: #555; font-size: .9rem; margin-top: .3rem; }
@media screen and (max-width: 44rem) {
  body { padding: 1.5rem 1rem 3rem; } h1 { font-size: 1.6rem; } h1, h2, p, a { overflow-wrap: anywhere; }
  .scroll { overflow-x: visible; } table, tbody { display: block; } thead { display: none; }
  tr { display: flex; flex-wrap: wrap; gap: .1rem 1rem; padding: .5rem 0; border-bottom: 1px solid #ececec; }
  td { padding: 0; border: 0; overflow-wrap: anywhere; } td:not([class]) { flex: 1 1 13rem; min-width: 0; }
  td:empty { display: none; }
  td[data-label]::before { content: attr(data-label) "\00a0 "; color: #666; font-size: .85em; }
  figure { flex-basis: 100%; } pre { white-space: pre-wrap; overflow-wrap: anywhere; }
}
@media screen and (prefers-color-scheme: dark) {
  tr { border-bottom-color: #2b2f34; } td[data-label]::before { color: #a0a5ab; }
  body { color: #ddd; background: #16181b; }
  h2 { border-top-color: #33373c; } .subtitle, figcaption { color: #a0a5ab; } nav ol { color: #8a9097; }
  a { color: #6cb6ff; } pre { background: #1f2226; border-color: #33373c; }
  th { border-bottom-color: #555; } td { border-bottom-color: #2b2f34; }
  .pass { background: #123d31; color: #8fe0c4; } .fail { background: #4d2410; color: #ffb48a; }
  .neutral { background: #33373c; color: #ccc; }
  figure svg { filter: invert(.92) hue-rotate(180deg); }
}
@media print {
  html { font-size: 12px; } body { max-width: none; padding: 0; } figure, tr, pre { break-inside: avoid; }
  h2 { break-after: avoid; } .scroll { overflow: visible; } a { color: inherit; }
}
)";

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {  // HTML forbids other control characters.
      result += static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t' ? ' ' : c;
    }
  }
  return result;
}

std::string badge(Verdict verdict, std::string_view text) {
  constexpr const char* kClasses[] = {"pass", "fail", "neutral"};
  return fmt::format("<span class=\"badge {}\">{}</span>", kClasses[static_cast<size_t>(verdict)], escaped(text));
}

bool is_number(const std::string& text) {
  return !text.empty() && (std::isdigit(static_cast<unsigned char>(text[0])) || text[0] == '-' || text[0] == '+') &&
         text.find_first_not_of("0123456789+-.eE% ") == std::string::npos;
}

// Numbers are right-aligned; short cells such as "<= 1e-6" are not wrapped.
std::string_view cell_class(const std::string& text) {
  if (is_number(text)) return " class=\"number\"";
  return text.size() <= 14 ? " class=\"short\"" : "";
}

void replace_all(std::string& text, std::string_view from, const std::string& to) {
  for (size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// Makes identifiers in a picture unique, because pictures of one page share a namespace.
std::string inline_svg(std::string svg, int index) {
  const size_t begin = svg.find("<svg");
  if (begin == std::string::npos) return "";
  svg.erase(0, begin);
  const std::string prefix = fmt::format("p{}_", index);
  replace_all(svg, " id=\"", " id=\"" + prefix);
  replace_all(svg, " id='", " id='" + prefix);
  replace_all(svg, "href='#", "href='#" + prefix);
  replace_all(svg, "href=\"#", "href=\"#" + prefix);
  replace_all(svg, "url(#", "url(#" + prefix);
  return svg;
}

std::string picture(const Figure& figure, int index) {
  const std::string bytes = read_file(figure.picture);
  if (figure.picture.extension() == ".svg") {
    const std::string svg = inline_svg(bytes, index);
    if (svg.empty()) throw InvalidInput(figure.picture.string() + ": holds no <svg> element");
    return svg;
  }
  if (figure.picture.extension() != ".png")
    throw InvalidInput(figure.picture.string() + ": a picture of a page must be .svg or .png");
  std::string coded;
  append_base64(bytes, coded);
  return fmt::format("<img alt=\"{}\" src=\"data:image/png;base64,{}\">", escaped(figure.caption), coded);
}

}  // namespace

ReportPage::ReportPage(std::string_view title, std::string_view subtitle)
    : title_(escaped(title)), subtitle_(escaped(subtitle)) {}

void ReportPage::heading(std::string_view text) {
  ++headings_;
  contents_ += fmt::format("<li><a href=\"#s{}\">{}</a></li>\n", headings_, escaped(text));
  body_ += fmt::format("<h2 id=\"s{}\">{}</h2>\n", headings_, escaped(text));
}

void ReportPage::paragraph(std::string_view text) { body_ += fmt::format("<p>{}</p>\n", escaped(text)); }

void ReportPage::formula(std::string_view mathml) { body_ += fmt::format("<p>{}</p>\n", mathml); }

void ReportPage::code(std::string_view text) { body_ += fmt::format("<pre>{}</pre>\n", escaped(text)); }

void ReportPage::verdict(Verdict verdict, std::string_view label, std::string_view text) {
  body_ += fmt::format("<p>{} {}</p>\n", badge(verdict, label), escaped(text));
}

void ReportPage::table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows) {
  body_ += "<div class=\"scroll\"><table>\n<thead><tr>";
  for (size_t column = 0; column < header.size(); ++column) {
    bool numbers = !rows.empty();
    for (const auto& row : rows) numbers = numbers && column < row.size() && is_number(row[column].text);
    body_ += fmt::format("<th{}>{}</th>", numbers ? " class=\"number\"" : "", escaped(header[column]));
  }
  body_ += "</tr></thead>\n<tbody>\n";
  // In a narrow window, names beside the cells replace the table header.
  const auto label = [&header](size_t column) {
    const bool has = column < header.size() && !header[column].empty();
    return has ? fmt::format(" data-label=\"{}\"", escaped(header[column])) : "";
  };
  for (const auto& row : rows) {
    body_ += "<tr>";
    for (size_t column = 0; column < row.size(); ++column) {
      const auto& [text, verdict] = row[column];
      body_ += fmt::format("<td{}{}>{}</td>", cell_class(text), label(column),
                           verdict ? badge(*verdict, text) : escaped(text));
    }
    body_ += "</tr>\n";
  }
  body_ += "</tbody></table></div>\n";
}

void ReportPage::figures(const std::vector<Figure>& row) {
  body_ += "<div class=\"figures\">\n";
  for (const Figure& figure : row)
    body_ += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n", picture(figure, ++pictures_),
                         escaped(figure.caption));
  body_ += "</div>\n";
}

std::string ReportPage::html() const {
  std::string page = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  page += fmt::format("<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n", title_, kStyle);
  page += fmt::format("<h1>{}</h1>\n", title_);
  if (!subtitle_.empty()) page += fmt::format("<p class=\"subtitle\">{}</p>\n", subtitle_);
  if (headings_ > 2) page += fmt::format("<nav><ol>\n{}</ol></nav>\n", contents_);
  return page + body_ + "</body>\n</html>\n";
}

void ReportPage::write(const fs::path& path) const { write_file(path, html()); }

}  // namespace aspic::cli
