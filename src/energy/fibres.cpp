#include "energy/fibres.h"

#include "energy/quadratic_batch.h"
#include "energy/tet_term.h"
#include "material/fibre_law.h"
#include "material/muscle_law.h"

namespace aspic {
namespace {

template <class Batch>
class Muscle final : public TetTerm<MuscleLaw, Energy, Batch> {
 public:
  using Term = TetTerm<MuscleLaw, Energy, Batch>;
  using Context = Energy::Context;

  Muscle(std::string name, const TetMesh& mesh, int first, std::span<const MuscleLaw::Params<double>> parameters,
         std::function<double(double)> activation)
      : Term(std::move(name), mesh, first, parameters), activation_(std::move(activation)) {}

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
  struct Activated : Context {
    std::vector<MuscleLaw::Params<Pack>> params;
  };

  void activate(double time, Activated& context) const {
    const Pack activation(activation_(time));
    context.params = this->params_;
    for (MuscleLaw::Params<Pack>& p : context.params) p.tension = activation * p.tension;
  }
  const std::vector<MuscleLaw::Params<Pack>>& params(const Context& context) const override {
    return static_cast<const Activated&>(context).params;
  }

  std::function<double(double)> activation_;
};

// Calls make.template operator()<Batch>() for the order of the elements.
template <class Make>
std::unique_ptr<Energy> for_order(const TetMesh& mesh, int first, bool is_empty, const Make& make) {
  if (!is_empty && is_quadratic(mesh, first)) return make.template operator()<QuadraticTetBatch>();
  return make.template operator()<TetBatch>();
}

}  // namespace

std::unique_ptr<Energy> make_fibres(std::string name, const TetMesh& mesh, int first, std::span<const Fibre> fibres) {
  std::vector<FibreLaw::Params<double>> parameters;
  parameters.reserve(fibres.size());
  for (const auto& [a, k1, k2, kappa] : fibres) parameters.push_back({k1, k2, kappa, a[0], a[1], a[2]});
  return for_order(mesh, first, fibres.empty(), [&]<class Batch>() -> std::unique_ptr<Energy> {
    return std::make_unique<TetTerm<FibreLaw, Energy, Batch>>(std::move(name), mesh, first, parameters);
  });
}

std::unique_ptr<Energy> make_muscle(std::string name, const TetMesh& mesh, int first,
                                    std::span<const MuscleFibre> fibres, std::function<double(double)> activation) {
  std::vector<MuscleLaw::Params<double>> parameters;
  parameters.reserve(fibres.size());
  for (const auto& [a, strength, optimal] : fibres) parameters.push_back({strength, optimal, a[0], a[1], a[2]});
  return for_order(mesh, first, fibres.empty(), [&]<class Batch>() -> std::unique_ptr<Energy> {
    return std::make_unique<Muscle<Batch>>(std::move(name), mesh, first, parameters, std::move(activation));
  });
}

}  // namespace aspic
