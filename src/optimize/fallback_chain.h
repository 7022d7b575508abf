// Several methods, the next of which takes over where the one before finds no step.
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
  // Each iteration begins with the first method.
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;
  // First by the method's own more cautious way, then by the next method.
  bool retreat() override;
  bool estimates_minimiser() const override;  // if all of them do

 private:
  void start(size_t method);

  std::vector<std::unique_ptr<SearchDirection>> methods_;
  size_t current_ = 0;
  bool retreated_ = false;  // the next compute() is at the same iterate
};

}  // namespace aspic
