#include "optimize/fallback_chain.h"

#include <algorithm>

#include "base/check.h"

namespace aspic {

FallbackChain::FallbackChain(std::vector<std::unique_ptr<SearchDirection>> methods) : methods_(std::move(methods)) {
  ASPIC_CHECK(!methods_.empty());
}

std::string FallbackChain::description() const {
  std::string text;
  for (const auto& method : methods_) text += (text.empty() ? "" : "; fallback: ") + method->description();
  return text;
}

// Drops the history of the method, because another method has moved the iterate since.
void FallbackChain::start(size_t method) {
  current_ = method;
  methods_[method]->begin();
}

void FallbackChain::begin() {
  start(0);
  fell_back_ = false;
}

bool FallbackChain::compute(const Iterate& at, std::span<double> d, DirectionReport& report) {
  if (!fell_back_ && current_ != 0) start(0);
  fell_back_ = false;
  return methods_[current_]->compute(at, d, report);
}

bool FallbackChain::fall_back() {
  fell_back_ = true;
  if (methods_[current_]->fall_back()) return true;
  if (current_ + 1 == methods_.size()) return false;
  start(current_ + 1);
  return true;
}

bool FallbackChain::estimates_minimizer() const {
  return std::all_of(methods_.begin(), methods_.end(), [](const auto& m) { return m->estimates_minimizer(); });
}

}  // namespace aspic
