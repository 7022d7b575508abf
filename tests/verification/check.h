// Checks: problems with known answers, and the findings for them.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace aspic::verify {

// Subject of the verification: thoroughness and replacements.
struct Subject {
  bool quick = false;                          // fewer and coarser cases: seconds instead of minutes
  std::map<std::string, std::string> instead;  // replaced materials, integrators, cuts, to see checks fail
  double stiffness = 1;  // factor of the moduli where all materials agree (small strains), to see checks fail

  std::string replacement(const std::string& name) const;  // the replacement of `name`, or `name`
};

struct Comparison {
  double measured, reference, tolerance;
};

// One judged value.
struct Row {
  std::string quantity;
  double measured, reference, tolerance;
  std::string unit;    // unit of all three; empty: none
  std::string reason;  // reason of the tolerance

  bool passes() const;  // |measured - reference| <= tolerance; false if not finite
};

enum class CurveStyle { line, dashed, points, line_and_points };

struct Curve {
  std::string label;
  std::vector<double> x, y;
  CurveStyle style = CurveStyle::line_and_points;
  int color = -1;  // index into the palette; -1: the next one
};

enum class Scales { linear, logarithmic };

struct Plot {
  std::string title, x_label, y_label;  // with units
  Scales scales = Scales::linear;
  std::vector<Curve> curves;
};

struct Findings {
  std::vector<Row> rows;
  std::vector<Plot> plots;

  bool passes() const;  // at least one row, and all rows pass
  void expect(std::string quantity, const Comparison& numbers, std::string reason, std::string unit = "");
  // Expects a value of zero.
  void expect_small(std::string quantity, double measured, double bound, std::string reason, std::string unit = "");
};

struct Check {
  std::string family, name;  // "integrators", "free_fall"; on the command line family/name
  std::string title;
  std::string problem;    // computed quantity, in a sentence or two
  std::string reference;  // source of the reference values
  std::function<void(const Subject&, Findings&)> run;
  std::vector<std::string> source = {};    // keys of docs/references.bib; empty: derived in `reference`
  std::vector<std::string> formulas = {};  // closed-form reference in TeX; empty if there is none

  std::string key() const { return family + "/" + name; }
};

const std::vector<Check>& checks();  // all checks, by family

// Runs a check. An exception becomes a failed row, as does a check without rows.
Findings run_check(const Check& check, const Subject& subject);

}  // namespace aspic::verify
