// The rows of the step table, within a memory bound.
#pragma once
#include <deque>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "results/explanation.h"
#include "viewer/arguments.h"

namespace aspic::viewer {

struct IterationRow {
  Iteration iteration;
  std::vector<Trial> tried;
};
Json to_json(const IterationRow& row);

// The iterations of a step, up to a maximum that protects memory and page.
class IterationRows {
 public:
  static constexpr size_t kMax = 5'000;  // maximum number of iterations and trials

  void begin() { rows_.clear(), size_ = 0; }
  void add(const LiveIteration& live);
  const std::vector<IterationRow>& rows() const { return rows_; }
  std::vector<IterationRow> take() { return std::move(rows_); }

 private:
  std::vector<IterationRow> rows_;
  size_t size_ = 0;
};
Json to_json(const std::vector<Trial>& tried);
Json to_json(const Explanation& why);  // null: no explanation

struct StepRow {
  static constexpr size_t kMaxReactions = 8;  // maximum shown: each vertex pinned by hand is a pin
  StepReport report;
  std::vector<IterationRow> iterations;
  double mouse_work = 0;               // work of the mouse in the step and in the edits before it [J]
  double tool_work = 0;                // work of the tool of an extension [J]
  double pin_work = 0;                 // as in the report, without mouse and tool [J]
  double load_work = 0;                // the same
  std::vector<std::string> pins = {};  // names of report.resultants.pins
  Explanation why;
};
Json to_json(const StepRow& row);
std::vector<std::string> pin_names(const Model& model);

class StepRows {
 public:
  static constexpr size_t kMaxSteps = 20'000;     // rows of earlier steps are dropped
  static constexpr size_t kMaxDetails = 300'000;  // iterations and trials; those of earlier steps are dropped

  void add(StepRow row);
  void drop_after(int step);
  void set_mesh_error(StepReport estimate);  // of the last row
  const StepRow* last() const { return rows_.empty() ? nullptr : &rows_.back(); }
  const StepRow* find(int step) const;
  Json after(int step) const;  // an array of rows

 private:
  void forget_details_of(StepRow& row);

  std::deque<StepRow> rows_;
  size_t details_ = 0;
};

}  // namespace aspic::viewer
