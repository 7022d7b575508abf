// A page of a session with the bench.
#pragma once
#include "bench/bench.h"
#include "viewer/session_test.h"

namespace aspic::bench {

using viewer::Json, viewer::number, viewer::Picture, viewer::sum, viewer::vec;

class BenchPage : public viewer::Page {
 public:
  explicit BenchPage(const std::string& toml, const std::vector<std::string>& overrides = {})
      : Page(toml, overrides, {.extension = bench()}) {}
};

}  // namespace aspic::bench
