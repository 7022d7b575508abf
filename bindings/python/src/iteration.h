// An iteration of a minimization, as observers in Python receive it.
#pragma once
#include <memory>

#include "function.h"
#include "optimize/minimize.h"

namespace aspic::python {

class ObservedIteration : public Iteration {
 public:
  ObservedIteration(const LiveIteration& live, const Layout& layout, std::shared_ptr<Callbacks> callbacks);
  void expire() { live_ = nullptr; }

  const LiveIteration& live() const;  // throws std::runtime_error after the observer has returned
  std::shared_ptr<Function> objective;
  Array trials;  // a row per trial: alpha, value, bound, accepted, by_slope

  Array out(std::span<const double> values) const { return objective->layout().out(values); }

 private:
  const LiveIteration* live_;
};

// Calls observe(iteration) with the GIL. A result of False stops the minimization.
IterationObserver observer_of(const py::object& observe, const Layout& layout, std::shared_ptr<Callbacks> callbacks);

}  // namespace aspic::python
