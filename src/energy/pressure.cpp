#include "energy/pressure.h"

#include <utility>

#include "energy/swept_volume.h"

namespace aspic {
namespace {

class SteadyPressure : public Pressure {
 public:
  SteadyPressure(SweptVolume volume, double pressure) : volume_(std::move(volume)), pressure_(pressure) {}

  std::string_view name() const override { return "pressure"; }
  void set_pressure(double pressure) override { pressure_ = pressure; }
  double pressure() const override { return pressure_; }
  double swept_volume(Positions x) const override { return volume_.value(x); }

  double value(Positions x, const Context&) const override { return pressure_ * volume_.value(x); }
  void add_gradient(Positions x, const Context&, double scale, std::span<double> g) const override {
    volume_.add_gradient(x, pressure_ * scale, g);
  }
  void add_couplings(Couplings& couplings) const override { volume_.add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { volume_.bind(pattern); }
  int add_hessian(Positions x, const Context&, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return volume_.add_hessian(x, pressure_, scale, projection, H);
  }

 private:
  SweptVolume volume_;
  double pressure_;
};

class VaryingPressure : public Energy {
 public:
  VaryingPressure(std::string name, SweptVolume volume, PressureOfTime pressure)
      : name_(std::move(name)), volume_(std::move(volume)), pressure_(std::move(pressure)) {}

  std::string_view name() const override { return name_; }
  double value(Positions x, const Context& context) const override {
    return pressure_(context.time) * volume_.value(x);
  }
  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    volume_.add_gradient(x, pressure_(context.time) * scale, g);
  }
  void add_couplings(Couplings& couplings) const override { volume_.add_couplings(couplings); }
  void bind(const BlockPattern& pattern) override { volume_.bind(pattern); }
  int add_hessian(Positions x, const Context& context, double scale, const Projection& projection,
                  BlockSparse& H) const override {
    return volume_.add_hessian(x, pressure_(context.time), scale, projection, H);
  }

 private:
  std::string name_;
  SweptVolume volume_;
  PressureOfTime pressure_;
};

}  // namespace

std::unique_ptr<Pressure> make_pressure(const TetMesh& mesh, std::span<const Face> patch, double pressure) {
  return std::make_unique<SteadyPressure>(SweptVolume(mesh, patch), pressure);
}

std::unique_ptr<Energy> make_pressure(std::string name, const TetMesh& mesh, std::span<const Face> patch,
                                      PressureOfTime pressure) {
  return std::make_unique<VaryingPressure>(std::move(name), SweptVolume(mesh, patch), std::move(pressure));
}

}  // namespace aspic
