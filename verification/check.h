// A problem with a known answer, and what was found of it.
#pragma once
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace aspic::verify {

// What is verified, and how closely.
struct Subject {
  bool quick = false;                          // fewer and coarser cases: seconds in place of minutes
  std::map<std::string, std::string> instead;  // materials, integrators, cuts: to see checks fail
  double stiffness = 1;  // multiplies the moduli where all materials are alike, at small strains: for the same purpose

  std::string taken_for(const std::string& name) const;  // the name itself, unless it is replaced
};

// One number that is judged.
struct Row {
  std::string quantity;
  double measured, reference, tolerance;
  std::string unit;    // of all three; empty: none
  std::string reason;  // why the tolerance is what it is

  bool passes() const;  // |measured - reference| <= tolerance; false for what is not a finite number
};

enum class CurveStyle { line, dashed, points, line_and_points };

struct Curve {
  std::string label;
  std::vector<double> x, y;
  CurveStyle style = CurveStyle::line_and_points;
  int color = -1;  // of the palette; -1: the next one
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

  bool passes() const;  // at least one row, and all of them pass
  void expect(std::string quantity, double measured, double reference, double tolerance, std::string reason,
              std::string unit = "");
  // expect() for a number that should be zero.
  void expect_small(std::string quantity, double measured, double bound, std::string reason, std::string unit = "");
};

struct Check {
  std::string family, name;  // "integrators", "free_fall"; the command line knows it as family/name
  std::string title;
  std::string problem;              // what is computed, in a sentence or two
  std::string reference;            // where the reference values come from
  std::vector<std::string> source;  // keys of docs/references.bib; empty: derived in `reference`
  std::function<void(const Subject&, Findings&)> run;

  std::string key() const { return family + "/" + name; }
};

const std::vector<Check>& checks();  // all of them, family by family

// What the check finds. What it throws becomes a failed row, and so does finding nothing.
Findings run_check(const Check& check, const Subject& subject);

}  // namespace aspic::verify
