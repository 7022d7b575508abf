#include "energy/fibres.h"

#include "energy/tet_term.h"
#include "material/fibre_law.h"
#include "material/muscle_law.h"

namespace aspic {
namespace {

class Muscle final : public TetTerm<MuscleLaw, Energy> {
 public:
  Muscle(std::string name, const TetMesh& mesh, int first, std::span<const Params<double>> parameters,
         std::function<double(double)> activation)
      : TetTerm(std::move(name), mesh, first, parameters), activation_(std::move(activation)) {}

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
    std::vector<Params<Pack>> params;
  };

  void activate(double time, Activated& context) const {
    const Pack activation(activation_(time));
    context.params = params_;
    for (Params<Pack>& p : context.params) p.tension = activation * p.tension;
  }
  const std::vector<Params<Pack>>& params(const Context& context) const override {
    return static_cast<const Activated&>(context).params;
  }

  std::function<double(double)> activation_;
};

}  // namespace

std::unique_ptr<Energy> make_fibres(std::string name, const TetMesh& mesh, int first, std::span<const Fibre> fibres) {
  std::vector<FibreLaw::Params<double>> parameters;
  parameters.reserve(fibres.size());
  for (const auto& [a, k1, k2, kappa] : fibres) parameters.push_back({k1, k2, kappa, a[0], a[1], a[2]});
  return std::make_unique<TetTerm<FibreLaw, Energy>>(std::move(name), mesh, first, parameters);
}

std::unique_ptr<Energy> make_muscle(std::string name, const TetMesh& mesh, int first,
                                    std::span<const MuscleFibre> fibres, std::function<double(double)> activation) {
  std::vector<MuscleLaw::Params<double>> parameters;
  parameters.reserve(fibres.size());
  for (const auto& [a, strength, optimal] : fibres) parameters.push_back({strength, optimal, a[0], a[1], a[2]});
  return std::make_unique<Muscle>(std::move(name), mesh, first, parameters, std::move(activation));
}

}  // namespace aspic
