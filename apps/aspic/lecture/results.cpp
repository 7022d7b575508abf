#include "aspic/lecture/results.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "aspic/formulas.h"
#include "aspic/lecture/result_json.h"
#include "io/atomic_file.h"

namespace aspic::cli::lecture {
namespace {

using Json = nlohmann::ordered_json;

std::string short_text(double value) {
  const bool is_count = std::abs(value) < 1e9 && value == std::floor(value);
  return is_count ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}
std::string value_text(const Measure& m) {
  return fmt::format("{}{}{}", short_text(m.value), m.unit.empty() ? "" : " ", m.unit);
}
std::string bound_text(const Measure& m) {
  return m.relation == Relation::shown ? "" : fmt::format("{} {}", to_string(m.relation), short_text(m.bound));
}

enum class PageVerdict { pass, fail, nothing_to_check };

PageVerdict verdict_of(int page, const std::vector<Result>& results) {
  bool any = false, passes = true;
  for (const Result& result : results) {
    const std::vector<int>& pages = result.demonstration->pages;
    if (!std::binary_search(pages.begin(), pages.end(), page)) continue;
    any = true;
    passes = passes && result.sheet.passes();
  }
  return !any ? PageVerdict::nothing_to_check : passes ? PageVerdict::pass : PageVerdict::fail;
}

const char* to_text(PageVerdict verdict) {
  constexpr const char* kTexts[] = {"pass", "fail", "nothing to check"};
  return kTexts[static_cast<size_t>(verdict)];
}

Verdict badge(PageVerdict verdict) {
  if (verdict == PageVerdict::pass) return Verdict::pass;
  return verdict == PageVerdict::fail ? Verdict::fail : Verdict::neutral;
}

std::vector<int> pages_with(PageVerdict verdict, const std::vector<Result>& results) {
  std::vector<int> pages;
  for (int page = 1; page <= kPages; ++page)
    if (verdict_of(page, results) == verdict) pages.push_back(page);
  return pages;
}

void write_json(const std::filesystem::path& path, const std::string& mesh, const std::vector<Result>& results) {
  Json json = {{"mesh", mesh}, {"pages", Json::array()}, {"demonstrations", Json::array()}};
  for (int page = 1; page <= kPages; ++page) {
    Json row = {{"page", page}, {"verdict", to_text(verdict_of(page, results))}, {"demonstrations", Json::array()}};
    if (const std::string reason = reason_for_none(page); !reason.empty()) row["reason"] = reason;
    for (const Demonstration* d : demonstrations_of(page)) row["demonstrations"].push_back(d->key);
    json["pages"].push_back(row);
  }
  for (const Result& result : results) json["demonstrations"].push_back(to_json(result));
  write_file(path, json.dump(2) + "\n");
}

void add_overview(ReportPage& page, const std::vector<Result>& results) {
  page.heading("All pages");
  page.paragraph(count_text(results));
  std::vector<std::vector<Cell>> rows;
  for (int page_number = 1; page_number <= kPages; ++page_number) {
    const PageVerdict verdict = verdict_of(page_number, results);
    std::string titles = reason_for_none(page_number);
    for (const Demonstration* d : demonstrations_of(page_number)) titles += (titles.empty() ? "" : "; ") + d->title;
    rows.push_back({{std::to_string(page_number)}, {titles}, {to_text(verdict), badge(verdict)}});
  }
  page.table({"page", "demonstration", ""}, rows);
}

void add_result(ReportPage& page, const Result& result) {
  const Demonstration& d = *result.demonstration;
  page.heading(fmt::format("{}: {}", pages_text(d.pages), d.title));
  page.verdict(result.sheet.passes() ? Verdict::pass : Verdict::fail, result.sheet.passes() ? "pass" : "fail",
               fmt::format("{:.1f} s", result.seconds));
  page.paragraph(d.claim);
  for (const std::string& formula : formulas_of(d.key)) page.formula(formula);
  page.code(fmt::format("aspic lecture {}", d.pages.front()));
  for (const std::string& remark : result.sheet.remarks()) page.paragraph(remark);
  std::vector<std::vector<Cell>> rows;
  for (const Measure& m : result.sheet.measures()) {
    Cell judged{""};
    if (m.relation != Relation::shown)
      judged = {m.holds() ? "pass" : "fail", m.holds() ? Verdict::pass : Verdict::fail};
    rows.push_back({{m.what}, {short_text(m.value)}, {bound_text(m)}, {m.unit}, judged, {m.reason}});
  }
  page.table({"measured", "value", "bound", "unit", "", "why"}, rows);
  if (!result.sheet.figures().empty()) page.figures(result.sheet.figures());
}

}  // namespace

void print(const Result& result) {
  const Demonstration& d = *result.demonstration;
  fmt::print("\npages {}: {}\n  claim: {}\n", pages_text(d.pages), d.title, d.claim);
  for (const std::string& remark : result.sheet.remarks()) fmt::print("  note: {}\n", remark);
  for (const Measure& m : result.sheet.measures()) {
    const char* mark = m.relation == Relation::shown ? "    " : m.holds() ? "pass" : "FAIL";
    fmt::print("  {}  {}: {}", mark, m.what, value_text(m));
    if (m.relation != Relation::shown) fmt::print("  ({})", bound_text(m));
    if (!m.reason.empty()) fmt::print("  {}", m.reason);
    fmt::print("\n");
  }
  fmt::print("{} ({:.1f} s); data and pictures in {}\n", result.sheet.passes() ? "PASS" : "FAIL", result.seconds,
             result.sheet.folder().string());
}

std::string count_text(const std::vector<Result>& results) {
  std::string text;
  for (const PageVerdict verdict : {PageVerdict::pass, PageVerdict::fail, PageVerdict::nothing_to_check}) {
    const std::vector<int> pages = pages_with(verdict, results);
    if (pages.empty() && verdict != PageVerdict::fail) continue;
    text += fmt::format("{}{} page{}: {}", text.empty() ? "" : "; ", pages.size(), pages.size() == 1 ? "" : "s",
                        to_text(verdict));
    if (verdict != PageVerdict::pass && !pages.empty()) text += fmt::format(" ({})", pages_text(pages));
  }
  return text;
}

void write_page(const std::filesystem::path& path, const std::string& mesh, const Result& result) {
  ReportPage page(result.demonstration->title, mesh);
  add_result(page, result);
  page.write(path);
}

void write_summary(const std::filesystem::path& folder, const std::string& mesh, const std::vector<Result>& results) {
  ReportPage page("From Energy to Motion", "The pages of the lecture, each judged by numbers; " + mesh);
  add_overview(page, results);
  for (const Result& result : results) add_result(page, result);
  page.write(folder / "index.html");
  write_json(folder / "lecture.json", mesh, results);
}

}  // namespace aspic::cli::lecture
