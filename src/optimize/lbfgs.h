// L-BFGS [Nocedal and Wright 2006, alg. 7.4]. The initial matrix is the Hessian at the first iterate, or another
// preconditioner B [Liu et al. 2017].
#pragma once
#include <vector>

#include "optimize/model_step.h"
#include "optimize/preconditioner.h"
#include "optimize/search_direction.h"

namespace aspic {

class LBFGS : public SearchDirection {
 public:
  explicit LBFGS(Preconditioner B) : B_(std::move(B)) {}
  std::string_view name() const override { return "lbfgs"; }
  std::string description() const override;
  void begin() override;
  bool compute(const Iterate& at, std::span<double> d, DirectionReport& report) override;
  bool fall_back() override;  // drops the pairs: d = -B^-1 g

 private:
  static constexpr int kPairs = 8;
  struct Pair {
    std::vector<double> s, y;  // changes of x and g
    double rho = 0;            // 1 / s.y
    double weight = 0;         // scratch of the two loops
  };
  Pair& recent(int age) { return pairs_[(next_ + kPairs - 1 - age) % kPairs]; }  // 0: the most recent
  void resize(size_t n);
  void remember(Objective& E, std::span<const double> x, std::span<const double> g);
  bool scale(const Iterate& at, std::span<double> d, DirectionReport& report);

  Preconditioner B_;
  ModelStep length_;
  Pair pairs_[kPairs];
  int count_ = 0, next_ = 0;
  bool has_last_ = false, corrected_ = false;  // a previous iterate is stored; the last direction used pairs
  std::vector<double> last_x_, last_g_, r_;
};

}  // namespace aspic
