// The table of keys. A new key is one entry; the order is that of docs/scene.md and of resolved scenes.
#include <set>

#include "dynamics/initial_guess.h"
#include "dynamics/simulation.h"
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
  s.sections.push_back({"scene", "*.toml", "The top level of the file."});
  add_keys(s, "scene",
           {{.name = "version", .accepts = kText, .meaning = "version of Aspic that resolved the scene"},
            {.name = "gravity",
             .accepts = kNumbers,
             .unit = "m/s^2",
             .fallback = "[0.0, -9.81, 0.0]",
             .meaning = "acceleration of gravity",
             .reason = "standard gravity along -y, the usual 'down'"},
            {.name = "time", .accepts = kTable, .fallback = "{}", .table = "time", .meaning = "time steps"},
            {.name = "solver",
             .accepts = kTable,
             .fallback = "{}",
             .table = "solver",
             .meaning = "minimization of each step"},
            {.name = "output", .accepts = kTable, .fallback = "{}", .table = "output", .meaning = "output files"},
            {.name = "body", .accepts = kTables, .required = true, .table = "body", .meaning = "the bodies"}});
}

void add_time(Schema& s) {
  const SimulationOptions usual;
  s.sections.push_back({"time", "[time]", "Time steps."});
  add_keys(
      s, "time",
      {{.name = "step",
        .accepts = kNumber,
        .unit = "s",
        .fallback = number_text(usual.h),
        .range = {.min = 0, .max = 1e100, .min_open = true},  // the square stays finite
        .meaning = "time step h",
        .reason = "resolves motions of a few hertz"},
       {.name = "duration",
        .accepts = kNumber,
        .unit = "s",
        .fallback = "2.0",
        .range = {.min = 0},
        .meaning = "simulated time; the last step reaches it",
        .reason = "several oscillations of a soft body"},
       {.name = "integrator",
        .accepts = kText,
        .fallback = toml_string(usual.integrator),
        .choices = integrator_names(),
        .meaning = kIntegrators,
        .reason = "stable for every step length"},
       {.name = "adaptive", .accepts = kTable, .fallback = "{}", .table = "adaptive", .meaning = "adaptive substeps"}});
  s.sections.push_back({"adaptive", "adaptive = { ... } in [time]",
                        "Each step is divided into substeps of `step` / 2^k. The difference between one substep and "
                        "two halves estimates its error. If the shortest substep (2^-20) is still inaccurate, the step "
                        "fails."});
  add_keys(s, "adaptive",
           {{.name = "tolerance",
             .accepts = kNumber,
             .fallback = number_text(usual.adaptive.tolerance),
             .range = {.min = 0, .max = 1},
             .meaning = "maximum position error per step, relative to the diagonal of the body at rest; 0: no "
                        "substeps. Not for bdf2 and quasi_static",
             .reason = "no extra cost"}});
}

void add_solver(Schema& s) {
  const SolverOptions usual;
  const std::string scale(to_string(usual.minimize.criterion));
  s.sections.push_back({"solver", "[solver]", "The minimization of each step ([methods](methods.md))."});
  add_keys(
      s, "solver",
      {{.name = "method",
        .accepts = kText,
        .fallback = toml_string(usual.method),
        .choices = minimizer_names(),
        .meaning = "search direction",
        .reason = "converges in a few iterations"},
       {.name = "fallback",
        .accepts = kNames,
        .fallback = "[]",
        .choices = minimizer_names(),
        .meaning = "methods that take over in this order if the previous one finds no step",
        .reason = "Newton's method finds a step by itself"},
       {.name = "preconditioner",
        .accepts = kText,
        .fallback = "\"auto\"",
        .choices = preconditioner_names(),
        .meaning = "approximation of the Hessian in `lbfgs`, `nonlinear_cg` and `gradient_descent`, made once per "
                   "step; `auto`: `hessian`, or `none` for `gradient_descent`",
        .reason = "fast; `gradient_descent` is as in the lecture"},
       {.name = "initial_guess",
        .accepts = kText,
        .fallback = toml_string(SimulationOptions().initial_guess),
        .choices = initial_guess_names(),
        .meaning =
            "initial guess of a minimization: `zero` rest shape, `current` positions, `extrapolated` q + h qdot, "
            "`last_increment` previous increment, `accelerated` previous accelerations, `best` the one of the last "
            "four with the lowest energy; it also replaces a guess of infinite energy",
        .reason = "never worse than the current positions"},
       {.name = "max_iterations",
        .accepts = kInteger,
        .fallback = std::to_string(usual.minimize.max_iterations),
        .range = {.min = 1, .max = 1e9},
        .meaning = "maximum iterations per step; beyond, the step has not converged",
        .reason = "far more than Newton's method usually needs"},
       {.name = "time_budget",
        .accepts = kNumber,
        .unit = "s",
        .fallback = number_text(usual.time_budget),
        .range = kNotNegative,
        .meaning = "wall time per step; beyond, the step ends with its best iterate and the status `budget`; 0: no "
                   "limit. Results are then not reproducible",
        .reason = "results are reproducible to the bit"},
       {.name = "tolerance",
        .accepts = kNumber,
        .fallback = number_text(usual.minimize.tolerance),
        .range = kNotNegative,
        .meaning = "threshold of `criterion`",
        .reason = "about six correct digits of positions"},
       {.name = "criterion",
        .accepts = kText,
        .fallback = toml_string(scale),
        .choices = criterion_names(),
        .meaning =
            "measure of convergence: norm of the gradient relative to the balancing forces (`scale`), to the first "
            "gradient, or in N (`absolute`); or Newton's direction: square root of the relative decrement "
            "(`decrement`), `velocity` in m/s, `acceleration` in m/s^2",
        .reason = "independent of units and initial guess"},
       {.name = "line_search",
        .accepts = kTable,
        .fallback = "{}",
        .table = "line_search",
        .meaning = "step length along a direction"},
       {.name = "linear",
        .accepts = kText,
        .fallback = toml_string(usual.linear),
        .choices = linear_solver_names(),
        .meaning = "linear solver",
        .reason = "chosen by predicted cost"},
       {.name = "definiteness",
        .accepts = kText,
        .fallback = toml_string(usual.definiteness),
        .choices = definiteness_names(),
        .meaning = "indefinite Hessians of `newton` and `newton_cg`: fail (`exact`); modify negative eigenvalues of "
                   "all elements always (`clamped`, `absolute` values), only when needed (`on_demand`, the meaning of "
                   "`auto`), or only at large residuals (`progressive`)",
        .reason = "projects only if necessary"},
       {.name = "mass",
        .accepts = kText,
        .fallback = "\"consistent\"",
        .choices = {"consistent", "lumped"},
        .meaning = "mass matrix",
        .reason = "second order in space at no extra cost in implicit steps"}});
}

void add_line_search(Schema& s) {
  const LineSearchOptions usual;
  s.sections.push_back({"line_search", "line_search = { ... } in [solver]",
                        "Backtracking: try alpha_max, then multiply by p until E has decreased enough."});
  add_keys(s, "line_search",
           {{.name = "alpha_max",
             .accepts = kNumber,
             .fallback = number_text(usual.alpha_max),
             .range = {.min = 0, .max = 1e6, .min_open = true},
             .meaning = "first trial",
             .reason = "the full Newton step"},
            {.name = "c",
             .accepts = kNumber,
             .fallback = number_text(usual.sufficient_decrease),
             .range = {.min = 0, .max = 1, .min_open = true, .max_open = true},
             .meaning = "sufficient decrease",
             .reason = "the textbook's value"},
            {.name = "p",
             .accepts = kNumber,
             .fallback = number_text(usual.shrink),
             .range = {.min = 0, .max = 0.99, .min_open = true},
             .meaning = "factor between trials",
             .reason = "halving"},
            {.name = "tol",
             .accepts = kNumber,
             .fallback = number_text(usual.tolerance),
             .range = {.min = 1e-16, .max = 1, .max_open = true},
             .meaning = "smallest step; below, the status is `stuck`",
             .reason = "about 33 halvings"},
            {.name = "test",
             .accepts = kText,
             .fallback = "\"textbook\"",
             .choices = decrease_test_names(),
             .meaning = "bound on E: `textbook` E + c alpha g.d (Armijo); `slide` E + c g.d, as printed in the "
                        "lecture; `none` accepts the first trial",
             .reason = "converges from any initial guess"}});
}

void add_output(Schema& s) {
  const OutputOptions usual;
  const auto format = [&](const char* name, bool on, const char* meaning, const char* reason) {
    add_key(
        s, "output",
        {.name = name, .accepts = kBoolean, .fallback = on ? "true" : "false", .meaning = meaning, .reason = reason});
  };
  s.sections.push_back({"output", "[output]", "Files of a run."});
  add_key(s, "output",
          {.name = "every",
           .accepts = kNumber,
           .unit = "s",
           .fallback = number_text(usual.every),
           .range = kNotNegative,
           .meaning = "simulated time between frames; 0: every step",
           .reason = "nothing is lost"});
  format("vtu", usual.vtu, "VTU frames for ParaView", "carries all fields");
  format("obj", usual.obj, "OBJ skin per frame", "large; PC2 contains the same");
  format("ply", usual.ply, "PLY skin per frame", "large; PC2 contains the same");
  format("pc2", usual.pc2, "PC2 cache for Blender", "small");
  format("usd", usual.usd, "USD text file", "opens in most 3-D programs");
  format("report", usual.report, "report.html", "opens in any browser; takes less time than the VTU frames");
  add_key(s, "output",
          {.name = "precision",
           .accepts = kText,
           .fallback = "\"single\"",
           .choices = {"single", "double"},
           .meaning = "precision of fields in VTU frames; positions are always double",
           .reason = "half as large"});
  add_key(s, "output",
          {.name = "checkpoint_every",
           .accepts = kNumber,
           .unit = "s",
           .fallback = number_text(usual.checkpoint_every),
           .range = kNotNegative,
           .meaning = "wall time between checkpoints; 0: with every frame",
           .reason = "Ctrl-C and `kill` lose nothing, a crash the last second"});
}

void add_material(Schema& s) {
  constexpr unsigned kField = kNumber | kExpression | kTable;
  const auto field = [&](Key key) {
    key.accepts = kField;
    key.table = "field";
    add_key(s, "material", key);
  };
  std::vector<std::string> models;
  for (const MaterialInfo& m : materials()) models.push_back(m.name);
  s.sections.push_back({"material", "material = { ... } in a [[body]]",
                        "Elastic constants at small strain, or a fitted material, `{ file = \"material.vtu\" }`."});
  add_key(s, "material",
          {.name = "model",
           .accepts = kText,
           .fallback = "\"neo_hookean\"",
           .choices = models,
           .meaning = "strain energy density; `aspic materials` prints the formulas",
           .reason = "stays finite for inverted elements"});
  field({.name = "density",
         .unit = "kg/m^3",
         .fallback = "1000.0",
         .range = kPositive,
         .meaning = "density at rest",
         .reason = "water and soft tissue"});
  field({.name = "young",
         .unit = "Pa",
         .fallback = "1e5",
         .range = kPositive,
         .meaning = "Young's modulus E",
         .reason = "soft silicone rubber"});
  field({.name = "poisson",
         .fallback = "0.3",
         .range = {.min = -1, .max = 0.5, .min_open = true, .max_open = true},
         .meaning = "Poisson's ratio nu",
         .reason = "linear tets lock above 0.45"});
  field({.name = "lambda", .unit = "Pa", .required = true, .meaning = "first Lame constant, > -2/3 mu"});
  field({.name = "mu", .unit = "Pa", .required = true, .range = kPositive, .meaning = "second Lame constant"});
  field({.name = "shear", .unit = "Pa", .required = true, .range = kPositive, .meaning = "shear modulus"});
  field({.name = "bulk", .unit = "Pa", .required = true, .range = kPositive, .meaning = "bulk modulus"});
  add_key(s, "material",
          {.name = "file",
           .accepts = kText,
           .required = true,
           .meaning = "material of `aspic fit` ([format](formats.md#materials)); each tet takes the values at its "
                      "centroid. A `density` here replaces that of the file"});
  add_key(s, "material",
          {.name = "frame",
           .accepts = kText,
           .fallback = "\"mesh\"",
           .choices = {"mesh", "scaled", "placed"},
           .meaning = "coordinates of the file: `mesh` those of the body's mesh file; `scaled` after `scale`; `placed` "
                      "also after rotate and translate",
           .reason = "the material was fitted on the mesh of the body"});
  add_key(s, "material", {.name = "hash", .accepts = kText, .meaning = "hash of the file, in resolved scenes"});
  std::set<std::string> known;
  for (const MaterialInfo& m : materials())
    for (const ExtraParameter& e : m.extra)
      if (known.insert(e.name).second)
        add_key(s, "material",
                {.name = e.name,
                 .accepts = kField,
                 .unit = e.unit,
                 .range = {.min = e.min, .max = e.max},
                 .table = "field",
                 .meaning = e.meaning + " (only " + m.name + "; default " + number_text(e.fallback) + ")"});
  s.alternatives.push_back(
      {"material", {{"young", "poisson"}, {"lambda", "mu"}, {"shear", "bulk"}, {"file", "frame", "hash"}}, false});

  s.sections.push_back(
      {"field", "a value per tet", "A number, a formula of the centroid (X, Y, Z) at rest, or a table:"});
  add_key(s, "field",
          {.name = "regions", .accepts = kAnyTable, .meaning = "a number per region label: { 1 = 1e5, 2 = 3e5 }"});
  add_key(s, "field",
          {.name = "file", .accepts = kText, .required = true, .meaning = "CSV with one number per tet, or VTU"});
  add_key(s, "field", {.name = "name", .accepts = kText, .meaning = "cell field of the VTU"});
  add_key(s, "field", {.name = "hash", .accepts = kText, .meaning = "hash of the file, in resolved scenes"});
  s.alternatives.push_back({"field", {{"regions"}, {"file", "name", "hash"}}, true});
}

}  // namespace

const Schema& scene_schema() {
  static const Schema schema = [] {
    Schema s;
    add_scene(s);
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
