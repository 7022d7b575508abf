// What the page hears of each step, kept within a bound of memory.
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "dynamics/explanation.h"
#include "dynamics/simulation.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

struct IterationRow {
  Iteration iteration;
  std::vector<Trial> tried;
};
Json to_json(const IterationRow& row);
Json to_json(const std::vector<Trial>& tried);
Json to_json(const Explanation& why);  // null when there is nothing to explain

struct StepRow {
  StepReport report;
  std::vector<IterationRow> iterations;
  double mouse_work = 0;  // within the step, and by what was done with the mouse before it [J]
  double pin_work = 0;    // by pins and by the other targets [J]
  Explanation why;
};
Json to_json(const StepRow& row);

class StepRows {
 public:
  static constexpr size_t kMostSteps = 20'000;          // rows of earlier steps are forgotten
  static constexpr size_t kMostWithIterations = 2'000;  // of the latest steps
  static constexpr size_t kMostIterations = 1'000;      // of a step

  void add(StepRow row);
  void drop_after(int step);
  void clear() { rows_.clear(); }
  const StepRow* last() const { return rows_.empty() ? nullptr : &rows_.back(); }
  const StepRow* find(int step) const;
  Json after(int step) const;  // an array

 private:
  std::deque<StepRow> rows_;
};

}  // namespace aspic::viewer
