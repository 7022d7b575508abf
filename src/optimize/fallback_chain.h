// A sequence of methods: if one finds no step, the next one is used.
#pragma once
#include <memory>
#include <vector>

#include "optimize/search_direction.h"

namespace aspic {

class FallbackChain : public SearchDirection {
 public:
  explicit FallbackChain(std::vector<std::unique_ptr<SearchDirection>> methods);  // at least one
  std::string_view name() const override { return methods_.front()->name(); }
  std::string description() const override;
  void begin() override;
  // Every iteration starts with the first method.
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;
  // Falls back within the current method, then to the next method.
  bool fall_back() override;
  bool estimates_minimizer() const override;  // if all methods do

 private:
  void start(size_t method);

  std::vector<std::unique_ptr<SearchDirection>> methods_;
  size_t current_ = 0;
  bool fell_back_ = false;  // the next compute() is at the same iterate
};

}  // namespace aspic
