// The result of one case of a study, from the folder of its run.
#pragma once
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace aspic::cli {

enum class CaseState { failed, unconverged, killed, stopped, running, not_begun, done };
constexpr int kCaseStates = 7;
std::string to_string(CaseState state);  // "not begun"

struct CaseResult {
  CaseState state = CaseState::not_begun;
  std::string reason;            // empty if done
  int steps = 0, all_steps = 0;  // computed and of the whole run; all_steps 0: unknown
  // Values of the run and of its last step, with the names of their columns.
  std::vector<std::pair<std::string, std::string>> values;

  std::string value(const std::string& name) const;  // empty if missing
};

// A run counts as done only if its table has every step and all of them converged. Throws nothing: unreadable files are
// a failure of the case.
CaseResult read_case(const std::filesystem::path& run);

}  // namespace aspic::cli
