// Sheets: stretching, bending, wind and contact against closed forms.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

#include "base/error.h"
#include "base/formatted.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "mesh/box.h"
#include "scene/scene.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

constexpr double kGravity = 9.81;  // [m/s^2]

// Runs a scene to its end. Returns the last report, which may not have converged.
Simulation sheet_at_end(const std::string& toml) {
  const TemporaryFolder folder;
  write_file(folder.path() / "scene.toml", toml);
  Scene scene = load_scene((folder.path() / "scene.toml").string());
  for (int i = 0; i < scene.steps; ++i) {
    const StepReport report = scene.simulation.step();
    if (!is_success(report.status)) throw InvalidInput("step " + std::to_string(i + 1) + " has not converged");
  }
  return std::move(scene.simulation);
}

std::string sheet_text(double value) { return formatted("%.17g", value); }

double mean_velocity(const Simulation& simulation, int axis) {
  double sum = 0, mass = 0;
  for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) {
    const double m = simulation.model().mass->vertex_mass()[v];
    sum += m * simulation.state().qdot[3 * static_cast<size_t>(v) + axis], mass += m;
  }
  return sum / mass;
}

// A sphere of radius R under the pressure p has the stretch s with W'(s) = p R s^2.
void check_balloon(const Subject& subject, Findings& found) {
  constexpr double R = 0.1, t = 1e-3, nu = 0.3, p = 2000;
  const double E = 1e6 * subject.stiffness, mu = 1e6 / (2 * (1 + nu)), la = 1e6 * nu / (1 - nu * nu);
  double low = 1, high = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double s = (low + high) / 2, slope = t * (mu * (2 * s - 2 / s) + 4 * la * std::log(s) / s);
    (slope < p * R * s * s ? low : high) = s;
  }
  const double size = subject.quick ? 0.02 : 0.01;
  const std::string balloon =
      "gravity = [0, 0, 0]\n[time]\nstep = 0.1\nduration = 2\n[[body]]\nshape = { sphere = { radius = 0.1, size = " +
      sheet_text(size) + " } }\nshell = { thickness = 1e-3, moment = 0 }\nmaterial = { young = " + sheet_text(E) +
      ", poisson = 0.3, density = 1000 }\n";
  const Simulation simulation = sheet_at_end(balloon + "[[body.pressure]]\nwhere = \"all\"\nvalue = -2000\n");
  const TetMesh& mesh = simulation.model().mesh;
  double stretch = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3d x = point(simulation.state().q, v);
    stretch += norm(x) / norm(mesh.rest[v]) / mesh.vertex_count();
  }
  found.expect("stretch of the balloon", {stretch, low, 0.2 * size / R * (low - 1) + 1e-6}, "the facets of the sphere");
  const Simulation filled = sheet_at_end(balloon + "[[body.cavity]]\nliquid = " + sheet_text(low * low * low) + "\n");
  const CavityState inside = filled.start_report().cavities[0];
  found.expect("pressure of the liquid that fills it", {inside.pressure, p, 0.2 * size / R * p},
               "the facets of the sphere", "Pa");
}

// A strip hangs under its weight from a clamped edge: w L^3 / (E I) = 10.
void check_strip(const Subject& subject, Findings& found) {
  constexpr double kDeflection = 0.7002;  // of the tip, over the length
  const double size = subject.quick ? 0.05 : 0.025;
  const Simulation simulation = sheet_at_end(
      "[time]\nstep = 0.1\nduration = 1\nintegrator = \"quasi_static\"\n[[body]]\nshape = { rectangle = { width = 1, "
      "height = 0.2, size = " +
      sheet_text(size) + " } }\nshell = { thickness = 1e-2, moment = " + sheet_text(0.981 * subject.stiffness) +
      " }\nrotate = { axis = [1, 0, 0], angle_deg = -90 }\nmaterial = { young = 1e8, poisson = 0, density = 100 }\n"
      "[[body.pin]]\nwhere = \"x < " +
      sheet_text(-0.5 + 1.01 * size) + "\"\n");
  const Box box = [&] {
    Box all;
    for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) all.add(point(simulation.state().q, v));
    return all;
  }();
  const double free_length = 1 - size / 2;  // hinges end halfway between the last fixed row and the first free one
  found.expect("deflection of the tip over the length",
               {-box.lower[1] / free_length, kDeflection, subject.quick ? 0.06 : 0.02},
               "the stiffness of hinges depends on the mesh; nearly equilateral triangles suit it");
}

// A level sheet that falls in still air.
void check_terminal_speed(const Subject&, Findings& found) {
  constexpr double kDensity = 200, kThickness = 1e-3, kAir = 1.2, kNormal = 1.2;
  const Simulation simulation = sheet_at_end(
      "gravity = [0, 0, -9.81]\n[wind]\nvelocity = [0, 0, 0]\n[time]\nstep = 0.02\nduration = 6\n[[body]]\n"
      "shape = { disc = { radius = 0.1, size = 0.05 } }\nshell = { thickness = 1e-3 }\nmaterial = { young = "
      "1e6, density = 200 }\n");
  const double speed = std::sqrt(2 * kDensity * kThickness * kGravity / (kAir * kNormal));
  found.expect("terminal speed", {-mean_velocity(simulation, 2), speed, 1e-6 * speed}, "the tolerance of the steps",
               "m/s");
}

// A sheet on a plane with gravity tilted by 20 degrees sticks or slides.
void check_incline(const Subject&, Findings& found) {
  constexpr double kAngle = std::numbers::pi / 9, kTime = 0.4;
  const double along = kGravity * std::sin(kAngle), across = kGravity * std::cos(kAngle);
  const auto speed = [&](double friction) {
    return mean_velocity(
        sheet_at_end(
            "gravity = [" + sheet_text(along) + ", 0, " + sheet_text(-across) +
            "]\n[time]\nstep = 0.004\nduration = 0.4\n[contact]\nfriction = " + sheet_text(friction) +
            "\nreach = 0.002\n[[obstacle]]\nplane = { normal = [0, 0, 1] }\n[[body]]\nshape = { rectangle = { width "
            "= 0.2, height = 0.2, size = 0.05 } }\nshell = { thickness = 1e-3 }\ntranslate = [0, 0, 0.0025]\n"
            "material = { young = 1e6, density = 1000 }\n"),
        0);
  };
  found.expect_small("speed with tan(20) < mu = 0.5", speed(0.5), 5e-3, "creep and the first steps", "m/s");
  const double sliding = (along - 0.2 * across) * kTime;
  found.expect("speed with mu = 0.2", {speed(0.2), sliding, 0.01 * sliding}, "the first steps, before it touches",
               "m/s");
}

// A sheet that spins and deforms in empty space.
void check_momentum(const Subject&, Findings& found) {
  const Simulation simulation = sheet_at_end(
      "gravity = [0, 0, 0]\n[time]\nstep = 0.01\nduration = 0.2\nintegrator = \"midpoint\"\n[solver]\ntolerance = "
      "1e-10\n"
      "[[body]]\nshape = { rectangle = { width = 0.3, height = 0.2, size = 0.05 } }\nshell = { thickness = 1e-3 }\n"
      "material = { young = 1e5, density = 500 }\nvelocity = [1, \"5 * x\", \"3 * y + 20 * x * y\"]\n"
      "angular_velocity = [1, 2, 3]\n");
  found.expect("velocity of the center of mass", {mean_velocity(simulation, 0), 1, 1e-9}, "the residual of the steps",
               "m/s");
  found.expect_small("velocity across", mean_velocity(simulation, 1), 1e-9, "the residual of the steps", "m/s");
}

}  // namespace

void add_sheet_checks(std::vector<Check>& checks) {
  checks.push_back(
      {"sheets",
       "balloon",
       "A balloon under pressure",
       "A sphere of neo-Hookean sheet without bending under a follower pressure, and filled with a given volume.",
       "Equilibrium of a sphere",
       check_balloon,
       {},
       {R"tex(W'(s) = p R s^2, \quad W = t \left(\tfrac{\mu}{2} (2 s^2 - 2 - 4 \ln s) + 2 \lambda \ln^2 s\right))tex"}});
  checks.push_back({"sheets",
                    "strip",
                    "A heavy strip of hinges",
                    "A strip that is clamped at one end hangs under its weight, with w L^3 / (E I) = 10.",
                    "The heavy elastica, solved as a boundary value problem",
                    check_strip,
                    {"Bisshopp1945"}});
  checks.push_back({"sheets",
                    "terminal_speed",
                    "A sheet falls in still air",
                    "The speed at which drag balances the weight of a level sheet.",
                    "Balance of forces",
                    check_terminal_speed,
                    {},
                    {R"tex(v = \sqrt{\frac{2 m g}{\rho\, C_n A}})tex"}});
  checks.push_back({"sheets",
                    "incline",
                    "A sheet on an incline",
                    "A sheet on a plane under gravity at 20 degrees sticks or slides.",
                    "Coulomb's law",
                    check_incline,
                    {},
                    {R"tex(v = (\sin\alpha - \mu \cos\alpha)\, g t)tex"}});
  checks.push_back({"sheets",
                    "momentum",
                    "A sheet that spins in empty space",
                    "The velocity of the center of mass of a sheet that deforms.",
                    "Conservation of momentum",
                    check_momentum,
                    {},
                    {R"tex(\dot p = 0)tex"}});
}

}  // namespace aspic::verify
