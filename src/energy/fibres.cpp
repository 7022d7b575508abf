#include "energy/fibres.h"

#include <utility>
#include <vector>

#include "energy/fibre_term.h"
#include "material/fibre_law.h"
#include "material/guccione_law.h"
#include "material/muscle_law.h"
#include "material/tension_law.h"
#include "material/weiss_law.h"

namespace aspic {
namespace {

// Returns the fibres of linear tets, with one direction per tet, for tets with more points.
template <class Fibre>
std::vector<Fibre> uniform(std::span<const Fibre> fibres) {
  std::vector<Fibre> list(fibres.begin(), fibres.end());
  for (Fibre& fibre : list) fibre.directions.fill(fibre.directions[0]);
  return list;
}

template <class Law, class Fibre, class Own>
std::unique_ptr<Energy> passive(const FibrePlace& place, std::span<const Fibre> fibres, const Own& own) {
  return for_order_of(place, fibres, [&]<class Batch>() -> std::unique_ptr<Energy> {
    auto term = std::make_unique<FibreTerm<Law, Energy, Batch>>(place, fibres, own);
    term->set_maker([name = place.name, first = place.first, list = uniform(fibres), own](const TetMesh& mesh) {
      return passive<Law>(FibrePlace{name, mesh, first}, std::span<const Fibre>(list), own);
    });
    return term;
  });
}

template <class Law, class Batch>
class Muscle final : public FibreTerm<Law, Energy, Batch> {
 public:
  using Term = FibreTerm<Law, Energy, Batch>;
  using Context = Energy::Context;

  template <class Fibre, class Own>
  Muscle(const FibrePlace& place, std::span<const Fibre> fibres, const Own& own, Activation activation)
      : Term(place, fibres, own), activation_(std::move(activation)) {}

  std::unique_ptr<Context> make_context() const override {
    auto context = std::make_unique<Activated>();
    activate(0, *context);
    return context;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    activate(step.time, static_cast<Activated&>(context));
  }

 private:
  using Packs = std::vector<typename Law::template Params<Pack>>;
  struct Activated : Context {
    Packs params;
  };

  void activate(double time, Activated& context) const {
    const Pack activation(activation_(time));
    context.params = this->params_;
    for (auto& p : context.params) p.tension = activation * p.tension;
  }
  const Packs& params(const Context& context) const override { return static_cast<const Activated&>(context).params; }

  Activation activation_;
};

template <class Law, class Fibre, class Own>
std::unique_ptr<Energy> active(const FibrePlace& place, std::span<const Fibre> fibres, const Own& own,
                               Activation activation) {
  return for_order_of(place, fibres, [&]<class Batch>() -> std::unique_ptr<Energy> {
    auto term = std::make_unique<Muscle<Law, Batch>>(place, fibres, own, activation);
    term->set_maker(
        [name = place.name, first = place.first, list = uniform(fibres), own, activation](const TetMesh& mesh) {
          return active<Law>(FibrePlace{name, mesh, first}, std::span<const Fibre>(list), own, activation);
        });
    return term;
  });
}

}  // namespace

int fibre_point_count(const TetMesh& mesh, int tet) { return is_quadratic(mesh, tet) ? 4 : 1; }

std::array<double, 4> fibre_point(const TetMesh& mesh, int tet, int point) {
  if (!is_quadratic(mesh, tet)) return {0.25, 0.25, 0.25, 0.25};
  std::array<double, 4> l;
  for (int i = 0; i < 4; ++i) l[i] = point_coordinate(point, i);
  return l;
}

std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const Fibre> fibres) {
  return passive<FibreLaw>(place, fibres, [](const Fibre& f) {
    return FibreLaw::Params<double>{f.stiffness, f.exponent, f.dispersion, 0, 0, 0};
  });
}

std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const GuccioneFibre> fibres) {
  return passive<GuccioneLaw>(place, fibres, [](const GuccioneFibre& f) {
    return GuccioneLaw::Params<double>{f.stiffness, f.along, f.across, f.shear, 0, 0, 0};
  });
}

std::unique_ptr<Energy> make_fibres(const FibrePlace& place, std::span<const WeissFibre> fibres) {
  return passive<WeissLaw>(place, fibres, [](const WeissFibre& f) {
    return WeissLaw::Params<double>{f.stiffness, f.exponent, f.straight_stretch, f.straight_stiffness, 0, 0, 0};
  });
}

std::unique_ptr<Energy> make_muscle(const FibrePlace& place, std::span<const MuscleFibre> fibres,
                                    Activation activation) {
  const auto own = [](const MuscleFibre& f) {
    return MuscleLaw::Params<double>{f.strength, f.optimal_stretch, 0, 0, 0};
  };
  return active<MuscleLaw>(place, fibres, own, std::move(activation));
}

std::unique_ptr<Energy> make_muscle(const FibrePlace& place, std::span<const TensionFibre> fibres,
                                    Activation activation) {
  const auto own = [](const TensionFibre& f) { return TensionLaw::Params<double>{f.strength, 0, 0, 0}; };
  return active<TensionLaw>(place, fibres, own, std::move(activation));
}

}  // namespace aspic
