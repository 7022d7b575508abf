// Objectives of the library as Python objects, and their Hessians.
#pragma once
#include <memory>
#include <string>

#include "arrays.h"
#include "callbacks.h"
#include "occupancy.h"
#include "optimize/objective.h"

namespace aspic::python {

// A symmetric matrix with its pattern. It owns both.
struct Hessian {
  Hessian(const BlockSparse& source, std::shared_ptr<const BlockPattern> its_pattern, Layout its_layout)
      : pattern(std::move(its_pattern)), layout(std::move(its_layout)), H(source) {
    H.pattern = pattern.get();
  }
  std::shared_ptr<const BlockPattern> pattern;
  Layout layout;
  BlockSparse H;
};

// E(x) with its derivatives. An objective lent to an observer expires when the observer returns.
class Function {
 public:
  Function(Objective* E, Layout layout, std::shared_ptr<Callbacks> callbacks)
      : callbacks_(std::move(callbacks)), E_(E), layout_(std::move(layout)) {}
  virtual ~Function() = default;
  Function(const Function&) = delete;
  Function& operator=(const Function&) = delete;

  virtual void set_pins_zero(std::span<double>) const {}  // in a direction
  Objective& E();                                         // throws std::runtime_error if it has expired
  void expire() { E_ = nullptr; }
  const Layout& layout() const { return layout_; }
  Callbacks& callbacks() { return *callbacks_; }
  Occupancy& occupancy() { return occupancy_; }

  double value(const py::handle& x);
  double round_off() const { return round_off_; }  // of the last value
  Array gradient(const py::handle& x);
  std::shared_ptr<Hessian> hessian(const py::handle& x, const std::string& definiteness);
  double max_step(const py::handle& x, const py::handle& d);

 protected:
  std::shared_ptr<Callbacks> callbacks_;
  Occupancy occupancy_;

 private:
  Objective* E_;
  Layout layout_;
  double round_off_ = 0;
  std::shared_ptr<const BlockPattern> pattern_;  // a copy of the last one
};

// Lends an objective to a function in Python, for a call. Other threads cannot use it, and nothing can afterwards,
// because the evaluations would meet those of the minimization. Requires the GIL in the constructor and the destructor.
class Lent {
 public:
  explicit Lent(std::shared_ptr<Function> f) : f_(std::move(f)), use_(f_->occupancy(), "objective") {
    f_->occupancy().advice = "inside of an observer, a direction or a line search, call it from the same thread";
  }
  ~Lent() { f_->expire(); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;
  const std::shared_ptr<Function>& operator*() const { return f_; }

 private:
  std::shared_ptr<Function> f_;
  Use use_;
};

Definiteness definiteness_named(const std::string& name);  // throws InvalidInput

}  // namespace aspic::python
