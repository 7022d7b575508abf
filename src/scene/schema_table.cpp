// The table of keys. A new key is one entry; the order is that of docs/scene.md and of resolved scenes.
#include <set>

#include "dynamics/initial_guess.h"
#include "dynamics/simulation.h"
#include "energy/wind.h"
#include "linalg/linear_solver.h"
#include "material/registry.h"
#include "scene/scene.h"
#include "scene/schema_table.h"

namespace aspic {
namespace {

const char* const kIntegrators =
    "time integration scheme ([formulas](integrators.md)). Implicit: `backward_euler` first order, damped; "
    "`linearly_implicit_euler` one Newton iteration of it; `bdf2`, `tr_bdf2` second order, damp unresolved motion; "
    "`midpoint`, `trapezoid` second order, undamped. Explicit, for short steps: `symplectic_euler` (the lecture's "
    "\"Forward Euler\"), `forward_euler` (gains energy), `rk4` fourth order. `quasi_static`: equilibrium";

void add_scene(Schema& s) {
  add_section(s, {"scene", "*.toml", "The top level of the file."},
              {key("version", kText, "version of Aspic that resolved the scene"),
               key("gravity", kNumbers, "acceleration of gravity", Units{"m/s^2"},
                   Usual{"[0.0, -9.81, 0.0]", "standard gravity along -y, the usual 'down'"}),
               key("time", kTable, "time steps", Members{"time"}, Usual{"{}"}),
               key("solver", kTable, "minimization of each step", Members{"solver"}, Usual{"{}"}),
               key("wind", kTable, "moving air around sheets", Members{"wind"}),
               key("output", kTable, "output files", Members{"output"}, Usual{"{}"}),
               key("body", kTables, "the bodies", Members{"body"}, kRequired),
               key("attach", kTables, "seams and other attachments of bodies", Members{"attach"})});
}

void add_wind(Schema& s) {
  const WindLaw usual;
  add_section(
      s,
      {"wind", "[wind]",
       "Drag on every triangle of a sheet: rho/2 times its area, the coefficients, and the square of the velocity "
       "of the air relative to it. Sheets do not shelter each other."},
      {key("velocity", kMovingExpressions, "velocity of the air, a function of the place (x, y, z) and t", Units{"m/s"},
           kRequired),
       key("density", kNumber, "density of the air", Units{"kg/m^3"}, kPositive,
           Usual{number_text(usual.density), "air at 20 degrees"}),
       key("normal", kNumber, "coefficient of drag across the sheet", kNotNegative,
           Usual{number_text(usual.normal_coefficient), "a square plate"}),
       key("tangential", kNumber, "coefficient of drag along the sheet", kNotNegative,
           Usual{number_text(usual.tangential_coefficient), "a smooth plate"})});
}

void add_time(Schema& s) {
  const SimulationOptions usual;
  add_section(s, {"time", "[time]", "Time steps."},
              {key("step", kNumber, "time step h", Units{"s"},
                   Range{.min = 0, .max = 1e100, .min_open = true},  // the square stays finite
                   Usual{number_text(usual.h), "resolves motions of a few hertz"}),
               key("duration", kNumber, "simulated time; the last step reaches it", Units{"s"}, Range{.min = 0},
                   Usual{"2.0", "several oscillations of a soft body"}),
               key("integrator", kText, kIntegrators, Choices{integrator_names()},
                   Usual{toml_string(usual.integrator), "stable for every step length"}),
               key("adaptive", kTable, "adaptive substeps", Members{"adaptive"}, Usual{"{}"})});
  add_section(s,
              {"adaptive", "adaptive = { ... } in [time]",
               "Each step is divided into substeps of `step` / 2^k. The difference between one substep and "
               "two halves estimates its error. If the shortest substep (2^-20) is still inaccurate, the step "
               "fails."},
              {key("tolerance", kNumber,
                   "maximum position error per step, relative to the diagonal of the body at rest; 0: no substeps. Not "
                   "for bdf2 and quasi_static",
                   Range{.min = 0, .max = 1}, Usual{number_text(usual.adaptive.tolerance), "no extra cost"})});
}

void add_solver(Schema& s) {
  const SolverOptions usual;
  const std::string scale(to_string(usual.minimize.criterion));
  add_section(
      s, {"solver", "[solver]", "The minimization of each step ([methods](methods.md))."},
      {key("method", kText, "search direction", Choices{minimizer_names()},
           Usual{toml_string(usual.method), "converges in a few iterations"}),
       key("fallback", kNames, "methods that take over in this order if the previous one finds no step",
           Choices{minimizer_names()}, Usual{"[]", "Newton's method finds a step by itself"}),
       key("preconditioner", kText,
           "approximation of the Hessian in `lbfgs`, `nonlinear_cg` and `gradient_descent`, made once per step; "
           "`auto`: `hessian`, or `none` for `gradient_descent`",
           Choices{preconditioner_names()}, Usual{"\"auto\"", "fast; `gradient_descent` is as in the lecture"}),
       key("initial_guess", kText,
           "initial guess of a minimization: `zero` rest shape, `current` positions, `extrapolated` q + h qdot, "
           "`last_increment` previous increment, `accelerated` previous accelerations, `best` the one of the last "
           "four with the lowest energy; it also replaces a guess of infinite energy",
           Choices{initial_guess_names()},
           Usual{toml_string(SimulationOptions().initial_guess), "never worse than the current positions"}),
       key("max_iterations", kInteger, "maximum iterations per step; beyond, the step has not converged",
           Range{.min = 1, .max = 1e9},
           Usual{std::to_string(usual.minimize.max_iterations), "far more than Newton's method usually needs"}),
       key("mesh_error", kText,
           "estimate the [error of the mesh](verification.md#the-error-of-the-mesh) after the last step, or with each "
           "frame",
           Choices{{"end", "frames", "off"}}, Usual{"\"end\"", "costs about as much as 60 iterations"}),
       key("time_budget", kNumber,
           "wall time per step; beyond, the step ends with its best iterate and the status `budget`; 0: no limit. "
           "Results are then not reproducible",
           Units{"s"}, kNotNegative, Usual{number_text(usual.time_budget), "results are reproducible to the bit"}),
       key("tolerance", kNumber, "threshold of `criterion`", kNotNegative,
           Usual{number_text(usual.minimize.tolerance), "about six correct digits of positions"}),
       key("criterion", kText,
           "measure of convergence: norm of the gradient relative to the balancing forces (`scale`), to the first "
           "gradient, or in N (`absolute`); or Newton's direction: square root of the relative decrement "
           "(`decrement`), `velocity` in m/s, `acceleration` in m/s^2",
           Choices{criterion_names()}, Usual{toml_string(scale), "independent of units and initial guess"}),
       key("line_search", kTable, "step length along a direction", Members{"line_search"}, Usual{"{}"}),
       key("linear", kText, "linear solver", Choices{linear_solver_names()},
           Usual{toml_string(usual.linear), "chosen by predicted cost"}),
       key("definiteness", kText,
           "indefinite Hessians of `newton` and `newton_cg`: fail (`exact`); modify negative eigenvalues of all "
           "elements always (`clamped`, `absolute` values), only when needed (`on_demand`, the meaning of "
           "`auto`), or only at large residuals (`progressive`)",
           Choices{definiteness_names()}, Usual{toml_string(usual.definiteness), "projects only if necessary"}),
       key("mass", kText, "mass matrix", Choices{{"consistent", "lumped"}},
           Usual{"\"consistent\"", "second order in space at no extra cost in implicit steps"})});
}

void add_line_search(Schema& s) {
  const LineSearchOptions usual;
  add_section(
      s,
      {"line_search", "line_search = { ... } in [solver]",
       "Backtracking: try alpha_max, then multiply by p until E has decreased enough."},
      {key("alpha_max", kNumber, "first trial", Range{.min = 0, .max = 1e6, .min_open = true},
           Usual{number_text(usual.alpha_max), "the full Newton step"}),
       key("c", kNumber, "sufficient decrease", Range{.min = 0, .max = 1, .min_open = true, .max_open = true},
           Usual{number_text(usual.sufficient_decrease), "the textbook's value"}),
       key("p", kNumber, "factor between trials", Range{.min = 0, .max = 0.99, .min_open = true},
           Usual{number_text(usual.shrink), "halving"}),
       key("tol", kNumber, "smallest step; below, the status is `stuck`",
           Range{.min = 1e-16, .max = 1, .max_open = true}, Usual{number_text(usual.tolerance), "about 33 halvings"}),
       key("test", kText,
           "bound on E: `textbook` E + c alpha g.d (Armijo); `slide` E + c g.d, as printed in the lecture; `none` "
           "accepts the first trial",
           Choices{decrease_test_names()}, Usual{"\"textbook\"", "converges from any initial guess"})});
}

void add_output(Schema& s) {
  const OutputOptions usual;
  const auto format = [&](const char* name, bool on, const char* meaning, const char* reason) {
    add_keys(s, "output", {key(name, kBoolean, meaning, Usual{on ? "true" : "false", reason})});
  };
  add_section(s, {"output", "[output]", "Files of a run."},
              {key("every", kNumber, "simulated time between frames; 0: every step", Units{"s"}, kNotNegative,
                   Usual{number_text(usual.every), "nothing is lost"})});
  format("vtu", usual.vtu, "VTU frames for ParaView", "carries all fields");
  format("obj", usual.obj, "OBJ skin per frame", "large; PC2 contains the same");
  format("ply", usual.ply, "PLY skin per frame", "large; PC2 contains the same");
  format("pc2", usual.pc2, "PC2 cache for Blender", "small");
  format("usd", usual.usd, "USD text file", "opens in most 3-D programs");
  format("mechanics", usual.mechanics, "F, strain, principal stresses and reactions of pins in VTU frames",
         "the displacement and the stress suffice for most pictures");
  format("report", usual.report, "report.html", "opens in any browser; takes less time than the VTU frames");
  add_keys(
      s, "output",
      {key("precision", kText, "precision of fields in VTU frames; positions are always double",
           Choices{{"single", "double"}}, Usual{"\"single\"", "half as large"}),
       key("checkpoint_every", kNumber, "wall time between checkpoints; 0: with every frame", Units{"s"}, kNotNegative,
           Usual{number_text(usual.checkpoint_every), "Ctrl-C and `kill` lose nothing, a crash the last second"})});
}

void add_material(Schema& s) {
  std::vector<std::string> models;
  for (const MaterialInfo& m : materials()) models.push_back(m.name);
  add_section(s,
              {"material", "material = { ... } in a [[body]]",
               "Elastic constants at small strain, or a fitted material, `{ file = \"material.vtu\" }`."},
              {key("model", kText, "strain energy density; `aspic materials` prints the formulas", Choices{models},
                   Usual{"\"neo_hookean\"", "stays finite for inverted elements"})});
  const auto field = [](std::string name, std::string meaning, auto... details) {
    return key(std::move(name), kNumber | kExpression | kTable, std::move(meaning), Members{"field"}, details...);
  };
  add_keys(
      s, "material",
      {field("density", "density at rest", Units{"kg/m^3"}, kPositive, Usual{"1000.0", "water and soft tissue"}),
       field("young", "Young's modulus E", Units{"Pa"}, kPositive, Usual{"1e5", "soft silicone rubber"}),
       field("poisson", "Poisson's ratio nu", Range{.min = -1, .max = 0.5, .min_open = true, .max_open = true},
             Usual{"0.3", "linear tets lock above 0.45"}),
       field("lambda", "first Lame constant, > -2/3 mu", Units{"Pa"}, kRequired),
       field("mu", "second Lame constant", Units{"Pa"}, kPositive, kRequired),
       field("shear", "shear modulus", Units{"Pa"}, kPositive, kRequired),
       field("bulk", "bulk modulus", Units{"Pa"}, kPositive, kRequired),
       key("file", kText,
           "material of `aspic fit` ([format](formats.md#materials)); each tet takes the values at its centroid. A "
           "`density` here replaces that of the file",
           kRequired),
       key("frame", kText,
           "coordinates of the file: `mesh` those of the body's mesh file; `scaled` after `scale`; `placed` also after "
           "rotate and translate",
           Choices{{"mesh", "scaled", "placed"}}, Usual{"\"mesh\"", "the material was fitted on the mesh of the body"}),
       key("hash", kText, "hash of the file, in resolved scenes")});
  std::set<std::string> known;
  for (const MaterialInfo& m : materials())
    for (const ExtraParameter& e : m.extra)
      if (known.insert(e.name).second)
        add_keys(s, "material",
                 {field(e.name, e.meaning + " (only " + m.name + "; default " + number_text(e.fallback) + ")",
                        Units{e.unit}, Range{.min = e.min, .max = e.max})});
  s.alternatives.push_back(
      {"material", {{"young", "poisson"}, {"lambda", "mu"}, {"shear", "bulk"}, {"file", "frame", "hash"}}, false});

  s.sections.push_back(
      {"field", "a value per tet", "A number, a formula of the centroid (X, Y, Z) at rest, or a table:"});
  add_keys(
      s, "field",
      {key("regions", kAnyTable,
           "a number per region, by label or [name](formats.md#names-of-surfaces-and-regions): { 1 = 1e5, inside = 3e5 "
           "}"),
       key("file", kText,
           "CSV with one number per tet; VTU; or a [painted surface](formats.md#painted-surfaces), placed like `mesh`",
           kRequired),
       key("name", kText, "cell field, or attribute"),
       key("range", kTwoNumbers, "values for 0 and 1 in the file; linear between"),
       key("hash", kText, "hash of the file, in resolved scenes")});
  s.alternatives.push_back({"field", {{"regions"}, {"file", "name", "range", "hash"}}, true});
}

}  // namespace

const Schema& scene_schema() {
  static const Schema schema = [] {
    Schema s;
    add_scene(s);
    add_wind(s);
    add_time(s);
    add_solver(s);
    add_line_search(s);
    add_output(s);
    add_body_sections(s);
    add_material(s);
    add_action_sections(s);
    add_contact_sections(s);
    return s;
  }();
  return schema;
}

}  // namespace aspic
