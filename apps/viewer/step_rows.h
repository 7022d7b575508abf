// What the page hears of each step, kept within a bound of memory.
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "scene/explanation.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

struct IterationRow {
  Iteration iteration;
  std::vector<Trial> tried;
};
Json to_json(const IterationRow& row);

// The iterations of a step as far as they are kept: one of very many would fill memory and page.
class IterationRows {
 public:
  static constexpr size_t kMost = 5'000;  // iterations and trials

  void begin() { rows_.clear(), size_ = 0; }
  void add(const LiveIteration& live);
  const std::vector<IterationRow>& rows() const { return rows_; }
  std::vector<IterationRow> take() { return std::move(rows_); }

 private:
  std::vector<IterationRow> rows_;
  size_t size_ = 0;
};
Json to_json(const std::vector<Trial>& tried);
Json to_json(const Explanation& why);  // null when there is nothing to explain

struct StepRow {
  static constexpr size_t kMostReactions = 8;  // shown: vertices that are pinned by hand are a pin each
  StepReport report;
  std::vector<IterationRow> iterations;
  double mouse_work = 0;               // within the step, and by what was done with the mouse before it [J]
  double probe_work = 0;               // of the probe [J]
  double pin_work = 0;                 // by pins and by the other targets [J]
  std::vector<std::string> pins = {};  // the names of report.resultants.pins
  Explanation why;
};
Json to_json(const StepRow& row);
std::vector<std::string> pin_names(const Model& model);

class StepRows {
 public:
  static constexpr size_t kMostSteps = 20'000;     // rows of earlier steps are forgotten
  static constexpr size_t kMostDetails = 300'000;  // iterations and trials; those of earlier steps are forgotten

  void add(StepRow row);
  void drop_after(int step);
  const StepRow* last() const { return rows_.empty() ? nullptr : &rows_.back(); }
  const StepRow* find(int step) const;
  Json after(int step) const;  // an array

 private:
  void forget_details_of(StepRow& row);

  std::deque<StepRow> rows_;
  size_t details_ = 0;
};

}  // namespace aspic::viewer
