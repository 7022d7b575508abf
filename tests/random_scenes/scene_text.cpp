#include "random_scenes/scene_text.h"

#include <array>
#include <charconv>

#include "material/registry.h"
#include "random_scenes/draw.h"

namespace aspic {

std::string shortest(double x) {
  std::array<char, 32> buffer{};
  return {buffer.data(), std::to_chars(buffer.data(), buffer.data() + buffer.size(), x).ptr};
}

namespace {

std::string in_quotes(const std::string& text) { return "\"" + text + "\""; }

class SceneText {
 public:
  explicit SceneText(uint64_t seed) : draw_(seed) {}

  std::string scene() {
    length_ = draw_.chance(0.15) ? draw_.logarithmic(1e-3, 1e3) : 1;
    young_ = draw_.chance(0.2) ? draw_.logarithmic(1, 1e12) : draw_.logarithmic(1e3, 1e8);
    text_ = draw_.chance(0.2) ? "gravity = " + draw_.vector(30) + "\n" : "";
    time();
    solver();
    const int bodies = draw_.chance(0.15) ? 2 : 1;
    for (int i = 0; i < bodies; ++i) body(i, bodies);
    return text_;
  }

 private:
  void line(const std::string& key, const std::string& value) { text_ += key + " = " + value + "\n"; }
  void choice(double probability, const std::string& key, std::initializer_list<const char*> names) {
    const std::string chosen = draw_.one_of(names);
    if (draw_.chance(probability)) line(key, in_quotes(chosen));
  }
  std::string meters(double low, double high) { return shortest(length_ * std::stod(draw_.number(low, high))); }
  std::string meters3(double size) {
    return "[" + meters(-size, size) + ", " + meters(-size, size) + ", " + meters(-size, size) + "]";
  }

  void time() {
    text_ += "[time]\n";
    const bool is_extreme = draw_.chance(0.15);
    h_ = std::stod(is_extreme ? draw_.size(1e-6, 1e3) : draw_.size(1e-3, 0.1));
    steps_ = draw_.integer(1, 4);
    is_explicit_ = draw_.chance(0.12);
    line("step", shortest(h_));
    line("duration", shortest(steps_ * h_));
    if (is_explicit_) {
      integrator_ = draw_.one_of({"symplectic_euler", "forward_euler", "rk4"});
    } else {
      integrator_ = draw_.one_of({"backward_euler", "backward_euler", "backward_euler", "bdf2", "tr_bdf2", "midpoint",
                                  "trapezoid", "quasi_static", "linearly_implicit_euler"});
    }
    line("integrator", in_quotes(integrator_));
    if (integrator_ != "bdf2" && integrator_ != "quasi_static" && draw_.chance(0.05))
      line("adaptive", "{ tolerance = " + draw_.size(1e-3, 1e-1) + " }");
  }

  void solver() {
    text_ += "[solver]\nmax_iterations = " + draw_.one_of<std::string>({"20", "60", "60"}) + "\n";
    choice(0.1, "mass", {"lumped", "consistent"});
    if (draw_.chance(0.15)) line("tolerance", draw_.size(1e-14, 1e-1));
    if (is_explicit_) return;
    const bool is_newton = integrator_ == "linearly_implicit_euler" || draw_.chance(0.7);
    const std::string method = is_newton ? draw_.one_of({"newton", "newton", "newton_cg"})
                                         : draw_.one_of({"lbfgs", "nonlinear_cg", "gradient_descent"});
    line("method", in_quotes(method));
    if (is_newton) {
      choice(0.6, "definiteness", {"on_demand", "progressive", "clamped", "absolute", "exact"});
      if (method == "newton") choice(0.4, "linear", {"cholesky", "multigrid", "block_jacobi"});
      choice(0.15, "criterion", {"decrement", "velocity", "acceleration", "first_gradient", "absolute"});
    } else {
      choice(0.7, "preconditioner", {"none", "mass", "diagonal", "hessian"});
      choice(0.15, "criterion", {"first_gradient", "absolute"});
    }
    if (integrator_ == "linearly_implicit_euler") return;
    if (integrator_ == "quasi_static") {
      choice(0.2, "initial_guess", {"zero", "current", "last_increment"});
    } else {
      choice(0.2, "initial_guess", {"zero", "current", "extrapolated", "last_increment", "accelerated"});
    }
    if (draw_.chance(0.1)) line("fallback", draw_.one_of({"[\"gradient_descent\"]", "[\"newton_cg\", \"lbfgs\"]"}));
    if (draw_.chance(0.2)) line_search();
  }

  void line_search() {
    line("line_search", "{ alpha_max = " + draw_.one_of<std::string>({"1", "0.5", "2", "1e6"}) +
                            ", c = " + draw_.one_of<std::string>({"1e-4", "0.1", "0.45", "0.9"}) +
                            ", p = " + draw_.number(0.1, 0.9) +
                            ", test = " + in_quotes(draw_.one_of({"textbook", "textbook", "slide", "none"})) + " }");
  }

  void body(int index, int count) {
    text_ += "[[body]]\n";
    line("name", in_quotes("body" + std::to_string(index)));
    shape();
    if (draw_.chance(0.1)) {  // slivers
      line("scale", "[1, " + draw_.size(1e-6, 1) + ", " + draw_.size(1e-3, 1e3) + "]");
    }
    if (draw_.chance(0.2)) line("rotate", "{ axis = [1, 2, 3], angle_deg = " + draw_.number(-180, 180) + " }");
    if (draw_.chance(0.2)) line("translate", draw_.chance(0.3) ? "[1e6, -1e6, 1e6]" : meters3(3));
    const bool is_elastic = !draw_.chance(0.05);
    if (!is_elastic) line("elastic", "false");
    material(is_elastic);
    if (is_elastic && draw_.chance(0.15)) line("order", "2");
    deform();
    if (draw_.chance(0.3)) line("velocity", draw_.vector(draw_.logarithmic(0.01, 100)));
    if (draw_.chance(0.2)) line("angular_velocity", draw_.vector(draw_.logarithmic(0.1, 1000)));
    if (draw_.chance(0.2)) damping();
    pins();
    springs(index, count, is_elastic);
    if (draw_.chance(0.15)) traction();
    if (draw_.chance(0.1))
      text_ += "[[body.force]]\nvalue = " + draw_.vector(young_ / length_ * draw_.logarithmic(1e-4, 10)) + "\n";
    viscoelastic();
  }

  void shape() {
    const int kind = draw_.integer(0, 5);
    if (kind <= 2) {
      const std::string cells = "[" + std::to_string(draw_.integer(1, 4)) + ", " + std::to_string(draw_.integer(1, 2)) +
                                ", " + std::to_string(draw_.integer(1, 3)) + "]";
      line("shape", "{ box = { upper = [" + meters(0.5, 2) + ", " + meters(0.2, 1) + ", " + meters(0.2, 1) +
                        "], cells = " + cells + (draw_.chance(0.3) ? ", cut = \"five\"" : "") + " } }");
    } else if (kind == 3) {
      line("shape", "{ cylinder = { radius = " + meters(0.2, 0.5) + ", height = " + meters(0.5, 2) +
                        ", size = " + meters(0.4, 0.6) + " } }");
    } else if (kind == 4) {
      line("shape", "{ sphere = { radius = " + meters(0.3, 0.6) + ", size = " + meters(0.4, 0.6) + " } }");
    } else {
      line("shape", "{ torus = { major_radius = " + meters(0.5, 0.7) + ", minor_radius = " + meters(0.2, 0.3) +
                        ", size = " + meters(0.4, 0.5) + " } }");
    }
  }

  void material(bool is_elastic) {
    std::string density = draw_.chance(0.2) ? draw_.size(1e-3, 1e6) : "1000";
    if (draw_.chance(0.05)) density = in_quotes("Y > 0.1 ? 1e6 : 1");
    if (!is_elastic) return line("material", "{ density = " + density + " }");
    const std::vector<MaterialInfo>& all = materials();
    const std::string& model = all[draw_.integer(0, static_cast<int>(all.size()) - 1)].name;
    std::string young = shortest(std::round(young_));
    if (draw_.chance(0.1)) young = in_quotes("X > " + meters(0, 1) + " ? " + young + " : " + draw_.size(1, 1e12));
    const std::string poisson = draw_.chance(0.1)
                                    ? draw_.one_of<std::string>({"0.4999", "0.499", "0.0", "-0.9", "-0.3"})
                                : draw_.chance(0.5) ? "0.3"
                                                    : draw_.number(0, 0.49);
    line("material", "{ model = " + in_quotes(model) + ", young = " + young + ", poisson = " + poisson +
                         ", density = " + density + " }");
  }

  void deform() {
    if (draw_.chance(0.5)) return;
    const std::string wobble = "sin(1e4*X/" + shortest(length_) + "+";
    const auto random = [&](const std::string& size) {
      std::string value = "[";
      for (const char* axis : {"2e4*Y", "3e4*Z", "5e4*(Y+Z)"})
        value += in_quotes(size + "*" + wobble + axis + "/" + shortest(length_) + ")") + (axis[0] == '5' ? "]" : ", ");
      return value;
    };
    switch (draw_.integer(0, 6)) {
      case 0:
        return line("deform", "{ scale = " + draw_.one_of<std::string>({"0", "0", "1e-3", "0.3", "3", "30"}) + " }");
      case 1:
        return line("deform", "{ scale = [" + draw_.one_of<std::string>({"0", "1", "2"}) + ", 1, " +
                                  draw_.one_of<std::string>({"0", "0", "0.5", "1"}) + "] }");
      case 2:
        return line("deform", draw_.one_of<std::string>({"{ matrix = [[-1, 0, 0], [0, 1, 0], [0, 0, 1]] }",
                                                         "{ matrix = [[0, 1, 0], [1, 0, 0], [0, 0, 1]] }",
                                                         "{ matrix = [[1, 2, 0], [0, 1, 0], [0, 0, 1]] }"}));
      case 3:
        return line("deform", "{ twist = { axis = [1, 0, 0], angle_deg = " + draw_.number(-720, 720) + " } }");
      case 4:
        return line("deform", "{ displacement = " + random(meters(0.3, 2)) + " }");
      default:
        return line("deform", "{ displacement = " + random(meters(0.001, 0.2)) + " }");
    }
  }

  void damping() {
    line("damping", "{ mass = " + draw_.one_of<std::string>({"0", "0.5", "50"}) +
                        ", stiffness = " + draw_.one_of<std::string>({"0", "0.001", "1"}) +
                        ", viscosity = " + draw_.one_of<std::string>({"0", "10", "1e5"}) + " }");
  }

  void viscoelastic() {
    const bool is_possible =
        integrator_ == "backward_euler" || integrator_ == "quasi_static" || integrator_ == "linearly_implicit_euler";
    for (int count = draw_.chance(0.15) ? draw_.integer(1, 3) : 0; count > 0; --count) {
      const std::string shear = shortest(young_ * draw_.logarithmic(1e-3, 10)),
                        time = shortest(h_ * draw_.logarithmic(1e-6, 1e6));
      if (is_possible) text_ += "[[body.viscoelastic]]\nshear = " + shear + "\nrelaxation_time = " + time + "\n";
    }
  }

  std::string motion() {
    const std::string until = shortest(0.5 * steps_ * h_);
    const double speed = draw_.logarithmic(1e-3, 2) * length_ / (steps_ * h_);
    switch (draw_.integer(0, 4)) {
      case 0:
        return "{ linear = { velocity = [" + shortest(speed) + ", 0, " + shortest(-speed) + "], until = " + until +
               " } }";
      case 1:
        return "{ rotate = { axis = [1, 0, 0], rate_deg = " + draw_.number(-1000, 1000) + " } }";
      case 2:
        return "{ keyframes = [{ time = " + until + ", displacement = " + meters3(1) + " }] }";
      case 3:
        return "{ displacement = [\"" + shortest(speed) + "*t\", 0, \"0.1*sin(t*X/" + shortest(length_) + ")\"] }";
      default:
        return "\"fixed\"";
    }
  }

  void pins() {
    const double kind = draw_.uniform(0, 1);
    if (kind < 0.3) return;
    if (kind < 0.33) {
      text_ += "[[body.pin]]\nwhere = \"all\"\nmotion = " + motion() + "\n";
      return;
    }
    text_ += "[[body.pin]]\nwhere = { lowest = " + draw_.number(0, 0.4) + " }\n";
    if (draw_.chance(0.2)) line("motion", motion());
    if (draw_.chance(0.3))
      text_ += "[[body.pin]]\nwhere = { highest = " + draw_.number(0, 0.4) + " }\nmotion = " + motion() + "\n";
  }

  void springs(int index, int count, bool is_elastic) {
    const auto stiffness = [&] { return shortest(young_ * length_ * std::stod(draw_.size(1e-4, 1e2))); };
    if (!is_elastic || draw_.chance(0.05)) text_ += "[[body.spring]]\nedges = true\nstiffness = " + stiffness() + "\n";
    if (draw_.chance(0.1))
      text_ += "[[body.spring]]\nwhere = { vertices = [0, 1] }\nmotion = " + motion() + "\nstiffness = " + stiffness() +
               "\n";
    if (draw_.chance(0.05))
      text_ +=
          "[[body.spring]]\nwhere = { vertices = [2] }\ntarget = " + meters3(2) + "\nstiffness = " + stiffness() + "\n";
    if (index == 0 && count == 2 && draw_.chance(0.7))
      text_ += "[[body.spring]]\nbetween = [[0, 1], [3, 2]]\nto_body = \"body1\"\nstiffness = " + stiffness() + "\n";
  }

  void traction() {
    const double pressure = young_ * draw_.logarithmic(1e-4, 3);
    text_ += "[[body.traction]]\nwhere = \"all\"\n" +
             (draw_.chance(0.5) ? "dead_pressure = " + shortest(draw_.chance(0.5) ? pressure : -pressure)
                                : "value = " + draw_.vector(pressure)) +
             "\n";
  }

  Draw draw_;
  std::string text_, integrator_;
  double length_ = 1, young_ = 1e5, h_ = 0.01;
  int steps_ = 1;
  bool is_explicit_ = false;
};

}  // namespace

std::string random_scene(uint64_t seed) { return SceneText(seed).scene(); }

}  // namespace aspic
