// Terms of fibres, whose directions vary between the quadrature points of a tet. Included only where it is
// instantiated.
#pragma once
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "energy/fibres.h"
#include "energy/quadratic_batch.h"
#include "energy/tet_term.h"

namespace aspic {

// Fibres are elements with the member `directions`. own(fibre): parameters of the law without the direction.
template <class Law, class Base, class Batch>
class FibreTerm : public TetTerm<Law, Base, Batch>, public TetEnergy {
 public:
  using Term = TetTerm<Law, Base, Batch>;
  using Params = typename Law::template Params<double>;

  template <class Fibre, class Own>
  FibreTerm(const FibrePlace& place, std::span<const Fibre> fibres, const Own& own)
      : Term(place.name, place.mesh, place.first, parameters(fibres, own)), first_(place.first) {
    for (int i = 0; i < Term::batch_count(); ++i)
      for (int q = 0; q < Term::kPoints; ++q)
        for (int l = 0; l < kPackWidth; ++l) {
          const Vec3d& a = fibres[this->batches_[i].tet[l] - place.first].directions[q];
          auto& p = this->params_[Term::place(i, q)];
          p.ax.set(l, a[0]), p.ay.set(l, a[1]), p.az.set(l, a[2]);
        }
  }

  // Makes the term of the same fibres on another mesh.
  using Maker = std::function<std::unique_ptr<Energy>(const TetMesh&)>;
  void set_maker(Maker maker) { maker_ = std::move(maker); }
  std::unique_ptr<Energy> on(const TetMesh& mesh) const override { return maker_(mesh); }
  int first_tet() const override { return first_; }

 private:
  Maker maker_;
  int first_;

  template <class Fibre, class Own>
  static std::vector<Params> parameters(std::span<const Fibre> fibres, const Own& own) {
    std::vector<Params> list;
    list.reserve(fibres.size());
    for (const Fibre& fibre : fibres) list.push_back(own(fibre));
    return list;
  }
};

// Calls make.template operator()<Batch>() for the order of the elements.
template <class Fibre, class Make>
auto for_order_of(const FibrePlace& place, std::span<const Fibre> fibres, const Make& make) {
  if (!fibres.empty() && is_quadratic(place.mesh, place.first)) return make.template operator()<QuadraticTetBatch>();
  return make.template operator()<TetBatch>();
}

}  // namespace aspic
