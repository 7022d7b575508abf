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

// Share of the free ring of a round cloth on a pedestal that lies in the shadow. Radii are 15 cm and 9 cm.
double drape_coefficient(double size, const Subject& subject) {
  constexpr double kCloth = 0.15, kPedestal = 0.09;
  const Simulation simulation = sheet_at_end(
      "gravity = [0, 0, -9.81]\n[time]\nstep = 0.1\nduration = 1\n[solver]\ntolerance = 1e-4\n[[body]]\nshape = { "
      "disc = { radius = 0.15, size = " +
      sheet_text(size) +
      " } }\nshell = { thickness = 1e-3, bending = \"mid_edge\", moment = " + sheet_text(1e-5 * subject.stiffness) +
      " }\nmaterial = { young = 1e6, poisson = 0.3, density = 150 }\nvelocity = [0, 0, \"0.1 * sin(9 * atan2(y, "
      "x))\"]\n[[body.pin]]\nwhere = \"hypot(x, y) < 0.0901\"\n");
  const TetMesh& mesh = simulation.model().mesh;
  std::vector<int> rim;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (norm(mesh.rest[v]) > kCloth * (1 - 1e-6)) rim.push_back(v);
  const auto angle = [&](int v) { return std::atan2(mesh.rest[v][1], mesh.rest[v][0]); };
  std::sort(rim.begin(), rim.end(), [&](int a, int b) { return angle(a) < angle(b); });
  double shadow = 0;
  for (size_t i = 0; i < rim.size(); ++i) {
    const Vec3d a = point(simulation.state().q, rim[i]), b = point(simulation.state().q, rim[(i + 1) % rim.size()]);
    shadow += (a[0] * b[1] - a[1] * b[0]) / 2;
  }
  const auto disc = [](double radius) { return std::numbers::pi * radius * radius; };
  return (shadow - disc(kPedestal)) / (disc(kCloth) - disc(kPedestal));
}

void check_drape(const Subject& subject, Findings& found) {
  const double fine = subject.quick ? 0.643 : drape_coefficient(0.007, {});
  found.expect("drape coefficient, 721 vertices against 1951", {drape_coefficient(0.0116, subject), fine, 0.02},
               "two points: wrinkles and the polygon of the rim");
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

// A strip is folded by a hand at x > 0.05 about the edges at x = 0, then released.
void check_crease(const Subject& subject, Findings& found) {
  constexpr double kCell = 0.1, kWidth = 0.3, kStiffness = 1e-3, kYield = 5e-3, kAngle = 2;
  std::string strip;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) strip += formatted("v %g %g 0\n", kCell * (i - 1), kCell * j);
  for (int i = 0; i < 3; ++i)
    for (int j = 1; j < 4; ++j) {
      const int a = 4 * i + j;
      strip += formatted("f %d %d %d\nf %d %d %d\n", a, a + 4, a + 5, a, a + 5, a + 1);
    }
  const TemporaryFolder folder;
  write_file(folder.path() / "strip.obj", strip);
  const std::string scene =
      "gravity = [0, 0, 0]\n[time]\nstep = 0.05\nduration = 1\nintegrator = \"quasi_static\"\n[solver]\ntolerance = "
      "1e-9\n[[body]]\nmesh = \"strip.obj\"\nshell = { thickness = 1e-3, moment = " +
      sheet_text(kStiffness * subject.stiffness) + ", yield = " + sheet_text(kYield) +
      " }\nmaterial = { young = 1e5, poisson = 0, density = 100 }\n[[body.pin]]\nwhere = \"X < 0.05\"\n";
  const std::string hand =
      "[[body.pin]]\nwhere = \"abs(X - 0.1) < 0.01\"\nmotion = { displacement = [\"X * (cos(2 * t) - 1)\", 0, \"X * "
      "sin(2 * t)\"] }\n";
  write_file(folder.path() / "fold.toml", scene + hand);
  write_file(folder.path() / "release.toml", scene);
  Simulation folds = load_scene((folder.path() / "fold.toml").string()).simulation;
  double loss = 0, moment = 0;
  for (int i = 0; i < 20; ++i) {
    const StepReport report = folds.step();
    loss += report.damping_loss;
    moment = std::abs(report.resultants.pins[1].moment[1]);
  }
  Simulation released = load_scene((folder.path() / "release.toml").string()).simulation;
  released.restore(folds.snapshot());
  loss += released.step().damping_loss;
  const TetMesh& mesh = released.model().mesh;
  double angle = 0;
  for (int v = 0; v < mesh.vertex_count(); ++v)
    if (const Vec3d x = point(released.state().q, v); mesh.rest[v][0] > 0.15) angle += std::atan2(x[2], x[0]) / 4;
  const double remaining = kAngle - kYield * kCell / kStiffness;
  found.expect("moment while it flows", {moment, kYield * kWidth, 1e-6 * kYield * kWidth}, "the tolerance", "N m");
  found.expect("angle after release", {angle, remaining, 1e-6}, "the tolerance", "rad");
  found.expect("loss", {loss, kYield * kWidth * remaining, 1e-6 * kYield * kWidth}, "the tolerance", "J");
}

// The sector of an annulus is sewn to a cone, from a cone that is too low.
void check_cone(const Subject& subject, Findings& found) {
  constexpr int kRings = 8, kColumns = 48;
  constexpr double kInner = 0.2, kOuter = 1, kShare = 2.0 / 3, kLow = 0.9;  // kShare: sector per full turn
  const double steep = std::sqrt(1 - kShare * kShare);
  std::string obj;
  for (int i = 0; i <= kRings; ++i) {
    const double r = kInner + (kOuter - kInner) * i / kRings;
    for (int j = 0; j <= kColumns; ++j) {
      const double turn = 2 * std::numbers::pi * j / kColumns, flat = kShare * turn;
      if (j < kColumns)
        obj += formatted("v %.17g %.17g %.17g\n", r * kShare * std::cos(turn), r * kShare * std::sin(turn),
                         -kLow * steep * r);
      obj += formatted("vt %.17g %.17g\n", (1 + r * std::cos(flat)) / 2, (1 + r * std::sin(flat)) / 2);
    }
  }
  const auto corner = [&](int i, int j) {
    obj += formatted(" %d/%d", i * kColumns + j % kColumns + 1, i * (kColumns + 1) + j + 1);
  };
  for (int i = 0; i < kRings; ++i)
    for (int j = 0; j < kColumns; ++j) {
      obj += "f";
      corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1);
      obj += "\n";
    }
  const TemporaryFolder folder;
  write_file(folder.path() / "cone.obj", obj);
  write_file(
      folder.path() / "scene.toml",
      "gravity = [0, 0, 0]\n[time]\nstep = 0.1\nduration = 0.5\nintegrator = \"quasi_static\"\n[[body]]\nmesh = "
      "\"cone.obj\"\nshell = { thickness = 1e-3, moment = 1e-7, rest = \"flat\", pattern = { uv_scale = " +
          sheet_text(2 / subject.stiffness) +
          " } }\nmaterial = { young = 1e6, poisson = 0.3, density = 200 }\n[[body.pin]]\nwhere = \"Z > -0.16\"\naxes "
          "= \"z\"\n[[body.pin]]\nwhere = \"max(-Z - 0.16, abs(Y) - 1e-3) < 0\"\naxes = \"y\"\n[[body.pin]]\nwhere = "
          "\"max(-Z - 0.16, abs(X) - 1e-3) < 0\"\naxes = \"x\"\n");
  Scene scene = load_scene((folder.path() / "scene.toml").string());
  for (int i = 0; i < scene.steps; ++i) scene.simulation.step();
  const Simulation& simulation = scene.simulation;
  double lower = 0, upper = -10;
  for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) {
    const double z = point(simulation.state().q, v)[2];
    lower = std::min(lower, z), upper = std::max(upper, z);
  }
  found.expect("height over slant length", {(upper - lower) / (kOuter - kInner), steep, 2e-3},
               "the facets of the cone");
}

// A square whose pattern is smaller.
void check_tight(const Subject& subject, Findings& found) {
  constexpr double kSide = 0.9, t = 1e-3, nu = 0.3;
  const double s = 1 / kSide, mu = 1e6 / (2 * (1 + nu)), la = 1e6 * nu / (1 - nu * nu);
  const TemporaryFolder folder;
  write_file(folder.path() / "square.obj",
             "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n");
  write_file(
      folder.path() / "scene.toml",
      "gravity = [0, 0, 0]\n[time]\nstep = 0.1\nduration = 0.1\n[[body]]\nmesh = \"square.obj\"\nshell = { thickness "
      "= 1e-3, pattern = { uv_scale = 0.9 } }\nmaterial = { young = " +
          sheet_text(1e6 * subject.stiffness) + ", poisson = 0.3, density = 200 }\n");
  const Scene scene = load_scene((folder.path() / "scene.toml").string());
  const double V = scene.simulation.model().elasticity[0]->value(scene.simulation.state().q);
  const double expected =
      kSide * kSide * t * (mu / 2 * (2 * s * s - 2 - 4 * std::log(s)) + 2 * la * std::log(s) * std::log(s));
  found.expect("energy of a sheet with a pattern 10 % smaller", {V, expected, 1e-10 * expected}, "round-off", "J");
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
                    "drape",
                    "Drape of a round cloth",
                    "A cloth of 30 cm, 150 g/m^2 and D = 1e-5 N m hangs over a pedestal of 18 cm in nine folds.",
                    "The same cloth on a finer mesh",
                    check_drape,
                    {"Cusick1968"},
                    {R"tex(DC = \frac{A_{shadow} - \pi r^2}{\pi R^2 - \pi r^2})tex"}});
  checks.push_back({"sheets",
                    "momentum",
                    "A sheet that spins in empty space",
                    "The velocity of the center of mass of a sheet that deforms.",
                    "Conservation of momentum",
                    check_momentum,
                    {},
                    {R"tex(\dot p = 0)tex"}});
  checks.push_back(
      {"sheets",
       "crease",
       "A strip is folded and released",
       "A strip of hinges with a yield moment is folded by an angle about one row of edges, then released.",
       "Perfect plasticity: the rest angle flows at the moment m per length",
       check_crease,
       {},
       {R"tex(\theta_0 = \theta - \frac{m h}{D}, \quad \text{loss} = m\, b\, |\theta_0|)tex"}});
  checks.push_back({"sheets",
                    "cone",
                    "A cone sewn from a flat sector",
                    "A sheet whose pattern is a sector of 240 degrees takes the shape of a cone.",
                    "The cone onto which the sector rolls up without stretching",
                    check_cone,
                    {},
                    {R"tex(\sin\alpha = \frac{240}{360})tex"}});
  checks.push_back({"sheets",
                    "tight",
                    "A sheet with a smaller pattern",
                    "A square sheet is stretched by 1 / .9 because its pattern is .9 as long.",
                    "Homogeneous deformation",
                    check_tight,
                    {},
                    {R"tex(V = A t \left(\tfrac{\mu}{2} (2 s^2 - 2 - 4 \ln s) + 2 \lambda \ln^2 s\right))tex"}});
}

}  // namespace aspic::verify
