#include "energy/wind.h"

#include <cmath>
#include <limits>
#include <utility>

#include "base/parallel.h"
#include "energy/element_groups.h"
#include "math/vectors.h"

namespace aspic {
namespace {

Vec3d centroid(Positions x, const Triangle& t) {
  return (1.0 / 3) * (vec_at(x, t[0]) + vec_at(x, t[1]) + vec_at(x, t[2]));
}

// A triangle in a step.
struct Sail {
  Vec3d wind;             // velocity of the air [m/s]
  Vec3d normal;           // n
  double pressure_scale;  // A rho/2 [kg/m]
  Vec3d start;            // centroid [m]
};

struct WindContext : Energy::Context {
  std::vector<Sail> sails;
};

// w, its parts along n and in the plane, and their lengths.
struct RelativeWind {
  Vec3d w, tangential;
  double along_normal, speed;

  RelativeWind(const Sail& sail, const Vec3d& velocity) : w(sail.wind - velocity), along_normal(dot(w, sail.normal)) {
    tangential = w - along_normal * sail.normal;
    speed = norm(tangential);
  }
};

class SheetWind : public Wind {
 public:
  SheetWind(std::vector<Triangle> triangles, const WindLaw& law, WindField velocity)
      : triangles_(std::move(triangles)), law_(law), velocity_(std::move(velocity)), groups_(triangles_) {}

  std::string_view name() const override { return "wind"; }

  std::unique_ptr<Context> make_context() const override {
    auto context = std::make_unique<WindContext>();
    context->sails.resize(triangles_.size());
    return context;
  }
  void begin_step(const StepContext& step, Context& context) const override {
    Energy::begin_step(step, context);
    const Positions shape = step.shape.empty() ? step.start : step.shape;
    std::vector<Sail>& sails = static_cast<WindContext&>(context).sails;
    for (size_t t = 0; t < triangles_.size(); ++t) {
      const Triangle& c = triangles_[t];
      const Vec3d origin = vec_at(shape, c[0]), N = cross(vec_at(shape, c[1]) - origin, vec_at(shape, c[2]) - origin);
      const double twice_area = norm(N);
      sails[t] = {velocity_(centroid(shape, c), step.time), twice_area > 0 ? (1 / twice_area) * N : Vec3d{},
                  0.25 * law_.density * twice_area, centroid(step.start, c)};
    }
  }

  double value(Positions x, const Context& context) const override {
    const double D = parallel_sum(count(), [&](int first, int last) {
      double sum = 0;
      for (int t = first; t < last; ++t) sum += potential(t, x, context);
      return sum;
    });
    return std::isnan(D) ? std::numeric_limits<double>::infinity() : D;
  }

  void add_gradient(Positions x, const Context& context, double scale, std::span<double> g) const override {
    groups_.for_each([&](int t) {
      const Sail& sail = sail_of(t, context);
      const Vec3d share = (-scale / 3) * force(sail, relative_wind(t, x, context));
      for (const int v : triangles_[t]) add_vec(share, v, g);
    });
  }

  void add_couplings(Couplings& couplings) const override {
    for (const Triangle& t : triangles_) aspic::add_couplings(t, couplings);
  }
  void bind(const BlockPattern& pattern) override {
    blocks_.resize(triangles_.size());
    parallel_for(count(), [&](int t) { blocks_[t].bind(triangles_[t], pattern); });
  }

  int add_hessian(Positions x, const Context& context, double scale, const Projection&, BlockSparse& H) const override {
    if (context.h == 0) return 0;
    return groups_.count_if([&](int t) {
      const Sail& sail = sail_of(t, context);
      const Mat3d K = resistance(sail, relative_wind(t, x, context));
      blocks_[t].add([&](int, int) -> const Mat3d& { return K; }, scale / (9 * context.h), H);
      return false;
    });
  }

  WindWork work(Positions x, const Context& context) const override {
    if (context.h == 0) return {};
    const auto sum_of = [&](const auto& power) {
      return context.h * parallel_sum(count(), [&](int first, int last) {
               double sum = 0;
               for (int t = first; t < last; ++t) sum += power(sail_of(t, context), relative_wind(t, x, context));
               return sum;
             });
    };
    return {sum_of([&](const Sail& sail, const RelativeWind& wind) { return dot(force(sail, wind), sail.wind); }),
            sum_of([&](const Sail& sail, const RelativeWind& wind) { return dissipation(sail, wind); })};
  }

 private:
  int count() const { return static_cast<int>(triangles_.size()); }
  static const Sail& sail_of(int t, const Context& context) {
    return static_cast<const WindContext&>(context).sails[t];
  }

  RelativeWind relative_wind(int t, Positions x, const Context& context) const {
    const Sail& sail = sail_of(t, context);
    if (context.h == 0) return {sail, {}};
    return {sail, (1 / context.h) * (centroid(x, triangles_[t]) - sail.start)};
  }

  // D of a triangle.
  double potential(int t, Positions x, const Context& context) const {
    const Sail& sail = sail_of(t, context);
    const RelativeWind wind = relative_wind(t, x, context);
    if (context.h == 0) return -dot(force(sail, wind), centroid(x, triangles_[t]) - sail.start);
    return context.h / 3 * dissipation(sail, wind);
  }

  // F . w
  double dissipation(const Sail& sail, const RelativeWind& wind) const {
    const double across = std::abs(wind.along_normal);
    return sail.pressure_scale * (law_.normal_coefficient * across * across * across +
                                  law_.tangential_coefficient * wind.speed * wind.speed * wind.speed);
  }

  Vec3d force(const Sail& sail, const RelativeWind& wind) const {
    const double across = law_.normal_coefficient * std::abs(wind.along_normal) * wind.along_normal;
    return sail.pressure_scale * (across * sail.normal + (law_.tangential_coefficient * wind.speed) * wind.tangential);
  }

  // dF/dw
  Mat3d resistance(const Sail& sail, const RelativeWind& wind) const {
    const double across = 2 * law_.normal_coefficient * std::abs(wind.along_normal);
    const double along = law_.tangential_coefficient * wind.speed;
    const Vec3d n = sail.normal, t = wind.speed > 0 ? (1 / wind.speed) * wind.tangential : Vec3d{};
    return sail.pressure_scale * (along * (identity3<double>() + outer(t, t)) + (across - along) * outer(n, n));
  }

  std::vector<Triangle> triangles_;
  WindLaw law_;
  WindField velocity_;
  std::vector<ElementBlocks<3>> blocks_;
  ElementGroups groups_;
};

}  // namespace

std::unique_ptr<Wind> make_wind(std::vector<Triangle> triangles, const WindLaw& law, WindField velocity) {
  return std::make_unique<SheetWind>(std::move(triangles), law, std::move(velocity));
}

}  // namespace aspic
