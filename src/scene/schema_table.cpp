// The table itself. A new key is one entry here; the order is the order of docs/scene.md and of resolved scenes.
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
    "the scheme that takes a step (formulas, orders, energies: [integrators](integrators.md)). Implicit, a "
    "minimisation "
    "per stage: `backward_euler` first order, damps; `linearly_implicit_euler` one Newton iteration of it; `bdf2` and "
    "`tr_bdf2` second order, damp only what the step does not resolve; `midpoint` and `trapezoid` second order, damp "
    "nothing and may gain energy in large deformations. Explicit, stable for short steps only: `symplectic_euler` "
    "(what the lecture's slide prints as \"Forward "
    "Euler\"), `forward_euler` (the classical one, gains energy), `rk4` fourth order. `quasi_static`: equilibrium, no "
    "inertia";

void add_scene(Schema& s) {
  s.sections.push_back({"scene", "*.toml", "What is simulated: the top level of the file."});
  add_keys(s, "scene",
           {{.name = "version",
             .accepts = kText,
             .meaning = "version of Aspic that resolved the scene; written by it, noted when it differs"},
            {.name = "gravity",
             .accepts = kNumbers,
             .unit = "m/s^2",
             .fallback = "[0.0, -9.81, 0.0]",
             .meaning = "acceleration of everything that has mass",
             .reason = "standard gravity along -y, the usual 'down'"},
            {.name = "time",
             .accepts = kTable,
             .fallback = "{}",
             .table = "time",
             .meaning = "steps and how they are taken"},
            {.name = "solver",
             .accepts = kTable,
             .fallback = "{}",
             .table = "solver",
             .meaning = "how each step's minimisation is solved"},
            {.name = "output", .accepts = kTable, .fallback = "{}", .table = "output", .meaning = "what is written"},
            {.name = "body", .accepts = kTables, .required = true, .table = "body", .meaning = "the bodies"}});
}

void add_time(Schema& s) {
  const SimulationOptions usual;
  s.sections.push_back({"time", "[time]", "The steps."});
  add_keys(s, "time",
           {{.name = "step",
             .accepts = kNumber,
             .unit = "s",
             .fallback = number_text(usual.h),
             .range = {.min = 0, .max = 1e100, .min_open = true},  // its square is finite
             .meaning = "length h of a time step",
             .reason = "resolves motions of a few hertz"},
            {.name = "duration",
             .accepts = kNumber,
             .unit = "s",
             .fallback = "2.0",
             .range = {.min = 0},
             .meaning = "simulated time; the last step is the first that reaches it",
             .reason = "long enough to see a soft body swing"},
            {.name = "integrator",
             .accepts = kText,
             .fallback = toml_string(usual.integrator),
             .choices = integrator_names(),
             .meaning = kIntegrators,
             .reason = "stable for every step length"},
            {.name = "adaptive",
             .accepts = kTable,
             .fallback = "{}",
             .table = "adaptive",
             .meaning = "steps in parts, as short as their error asks for: [integrators](integrators.md)"}});
  s.sections.push_back(
      {"adaptive", "adaptive = { ... } in [time]",
       "Each step is taken in parts of `step` / 2^k. A part is taken once whole and once in halves, "
       "whose difference estimates its error; parts too long are rejected and halved, and a step whose "
       "smallest part (2^-20) is still inaccurate is reported as such. Frames and restarts stay at "
       "multiples of `step`."});
  add_keys(s, "adaptive",
           {{.name = "tolerance",
             .accepts = kNumber,
             .fallback = number_text(usual.adaptive.tolerance),
             .range = {.min = 0, .max = 1},
             .meaning = "error in position that a step may add, relative to the diagonal of the body at rest; 0: steps "
                        "are taken whole. Not for bdf2 and quasi_static",
             .reason = "a step costs what it did before"}});
}

void add_solver(Schema& s) {
  const SolverOptions usual;
  const std::string scale(to_string(usual.minimize.criterion));
  s.sections.push_back({"solver", "[solver]", "The minimisation of each step."});
  add_keys(
      s, "solver",
      {{.name = "method",
        .accepts = kText,
        .fallback = toml_string(usual.method),
        .choices = minimizer_names(),
        .meaning = "how the search direction is found",
        .reason = "converges in a few iterations"},
       {.name = "fallback",
        .accepts = kNames,
        .fallback = "[]",
        .choices = minimizer_names(),
        .meaning = "methods that take over, in this order, where the one before finds no step; the next iteration "
                   "begins with `method` again",
        .reason = "Newton's method finds a step by itself"},
       {.name = "preconditioner",
        .accepts = kText,
        .fallback = "\"auto\"",
        .choices = preconditioner_names(),
        .meaning = "the matrix that stands for the Hessian in `lbfgs`, `nonlinear_cg` and `gradient_descent`: made at "
                   "the first iterate of each step and kept",
        .reason = "`hessian`, for `gradient_descent` `none`, as in the lecture"},
       {.name = "initial_guess",
        .accepts = kText,
        .fallback = toml_string(SimulationOptions().initial_guess),
        .choices = initial_guess_names(),
        .meaning = "where a minimisation starts: `zero` the shape at rest, `current` where the body is, `extrapolated` "
                   "its flight without forces q + h qdot, `last_increment` what the step before added, `accelerated` "
                   "the flight with the accelerations of the step before, `best` the one of the last four with the "
                   "lowest energy. A guess of infinite energy, or not known yet, gives way "
                   "to the best",
        .reason = "never worse than where the body is"},
       {.name = "max_iterations",
        .accepts = kInteger,
        .fallback = std::to_string(usual.minimize.max_iterations),
        .range = {.min = 1, .max = 1e9},
        .meaning = "iterations per step; a step that needs more is reported as not converged",
        .reason = "far more than Newton's method takes, but for the hardest steps"},
       {.name = "time_budget",
        .accepts = kNumber,
        .unit = "s",
        .fallback = number_text(usual.time_budget),
        .range = kNotNegative,
        .meaning = "wall time per step; a step that needs more ends where it came, with an energy not above that of "
                   "its start and the status `budget`; 0: no limit. At least one iteration is tried, however long it "
                   "takes. What a step with a budget computes depends on the clock",
        .reason = "results are reproducible to the bit"},
       {.name = "tolerance",
        .accepts = kNumber,
        .fallback = number_text(usual.minimize.tolerance),
        .range = kNotNegative,
        .meaning = "how small `criterion` must be for a step to have converged",
        .reason = "positions are then right to about six digits"},
       {.name = "criterion",
        .accepts = kText,
        .fallback = toml_string(scale),
        .choices = criterion_names(),
        .meaning = "what must be small, and in which unit: the gradient's norm, relative to the forces that balance "
                   "(`scale`), to the first gradient of the step, or in N (`absolute`); or Newton's direction, as the "
                   "square root of its decrement relative to the energy of doubling the body in size (`decrement`), as "
                   "a `velocity` in m/s or an `acceleration` in m/s^2",
        .reason = "means the same in every unit and for every start"},
       {.name = "line_search",
        .accepts = kTable,
        .fallback = "{}",
        .table = "line_search",
        .meaning = "how far to go along a direction"},
       {.name = "linear",
        .accepts = kText,
        .fallback = toml_string(usual.linear),
        .choices = linear_solver_names(),
        .meaning = "the solver of the linear systems of Newton's method and of the preconditioner `hessian`",
        .reason = "chosen by predicted cost"},
       {.name = "definiteness",
        .accepts = kText,
        .fallback = toml_string(usual.definiteness),
        .choices = definiteness_names(),
        .meaning = "what is done to an indefinite Hessian: refuse it (`exact`), or raise the negative eigenvalues of "
                   "elements always (`clamped`, or to their `absolute` values), where a direction is of no use "
                   "(`on_demand`), and there only of elements with large residuals (`progressive`); for `newton` and "
                   "`newton_cg`",
        .reason = "projects only when it has to"},
       {.name = "mass",
        .accepts = kText,
        .fallback = "\"consistent\"",
        .choices = {"consistent", "lumped"},
        .meaning = "the mass matrix",
        .reason = "second-order accurate in space, and costs nothing extra in an implicit step"}});
}

void add_line_search(Schema& s) {
  const LineSearchOptions usual;
  s.sections.push_back({"line_search", "line_search = { ... } in [solver]",
                        "Backtracking: try alpha_max, then shrink by p until E has decreased enough."});
  add_keys(s, "line_search",
           {{.name = "alpha_max",
             .accepts = kNumber,
             .fallback = number_text(usual.alpha_max),
             .range = {.min = 0, .max = 1e6, .min_open = true},
             .meaning = "the first trial",
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
             .meaning = "steps shorter than this are given up as stuck",
             .reason = "about 33 halvings"},
            {.name = "test",
             .accepts = kText,
             .fallback = "\"textbook\"",
             .choices = decrease_test_names(),
             .meaning = "`textbook`: E + c alpha g.d (Armijo); `slide`: E + c g.d, as printed in the lecture; `none`: "
                        "accept the first trial",
             .reason = "converges from everywhere"}});
}

void add_output(Schema& s) {
  const OutputOptions usual;
  const auto format = [&](const char* name, bool on, const char* meaning, const char* reason) {
    add_key(
        s, "output",
        {.name = name, .accepts = kBoolean, .fallback = on ? "true" : "false", .meaning = meaning, .reason = reason});
  };
  s.sections.push_back({"output", "[output]", "The files of a run."});
  add_key(s, "output",
          {.name = "every",
           .accepts = kNumber,
           .unit = "s",
           .fallback = number_text(usual.every),
           .range = kNotNegative,
           .meaning = "simulated time between frames; 0: a frame per step",
           .reason = "nothing is lost"});
  format("vtu", usual.vtu, "VTU frames with a PVD index, for ParaView", "carries all fields");
  format("obj", usual.obj, "an OBJ file per frame", "large; PC2 holds the same");
  format("ply", usual.ply, "a PLY file per frame", "large; PC2 holds the same");
  format("pc2", usual.pc2, "a PC2 cache with its OBJ, for Blender", "small");
  format("usd", usual.usd, "one time-sampled USD text file", "opens in most 3-D programs");
  format("report", usual.report, "report.html, one page with playback, plots and certificate, from `aspic run`",
         "opens in any browser; takes less time than the VTU frames");
  add_key(s, "output",
          {.name = "precision",
           .accepts = kText,
           .fallback = "\"single\"",
           .choices = {"single", "double"},
           .meaning = "of velocities, displacements and fields in VTU frames; positions are always double",
           .reason = "half as large"});
  add_key(s, "output",
          {.name = "checkpoint_every",
           .accepts = kNumber,
           .unit = "s",
           .fallback = number_text(usual.checkpoint_every),
           .range = kNotNegative,
           .meaning = "wall time between checkpoints; 0: with every frame",
           .reason = "ctrl-C and `kill` lose nothing, a crash the last second"});
}

void add_material(Schema& s) {
  constexpr unsigned kField = kNumber | kExpression | kTable;
  const auto field = [&](const char* name, const char* unit, const char* fallback, Range range, const char* meaning,
                         const char* reason, bool required) {
    add_key(s, "material",
            {.name = name,
             .accepts = kField,
             .unit = unit,
             .fallback = fallback,
             .required = required,
             .range = range,
             .table = "field",
             .meaning = meaning,
             .reason = reason});
  };
  std::vector<std::string> models;
  for (const MaterialInfo& m : materials()) models.push_back(m.name);
  s.sections.push_back({"material", "material = { ... } in a [[body]]",
                        "Elastic constants at small strain, whatever the model does at large strain. Each value is a "
                        "number, a formula of the centroid (X, Y, Z) of a tet at rest, or a `field` table. Or all "
                        "of them come from a material that was fitted: `material = { file = \"material.vtu\" }`, see "
                        "[fitting](fitting.md)."});
  add_key(s, "material",
          {.name = "model",
           .accepts = kText,
           .fallback = "\"neo_hookean\"",
           .choices = models,
           .meaning = "the energy density; `aspic materials` prints each formula",
           .reason = "stays finite when elements are turned inside out"});
  field("density", "kg/m^3", "1000.0", kPositive, "mass per volume at rest", "water and soft tissue", false);
  field("young", "Pa", "1e5", kPositive, "Young's modulus E", "soft silicone rubber", false);
  field("poisson", "", "0.3", {.min = -1, .max = 0.5, .min_open = true, .max_open = true}, "Poisson's ratio nu",
        "linear tets lock above 0.45", false);
  field("lambda", "Pa", "", {}, "first Lame constant; above -2/3 mu", "", true);
  field("mu", "Pa", "", kPositive, "second Lame constant, the shear modulus", "", true);
  field("shear", "Pa", "", kPositive, "shear modulus", "", true);
  field("bulk", "Pa", "", kPositive, "bulk modulus", "", true);
  add_key(
      s, "material",
      {.name = "file",
       .accepts = kText,
       .required = true,
       .meaning = "a material as `aspic fit` writes it: a VTU with tets, the field of the file `model NAME` and the "
                  "cell fields `young`, `poisson`, the model's own and, where it is known, `density`. Each tet "
                  "takes the values of the tet of the file in which its centroid lies, or of the nearest; the "
                  "meshes need not be the same. A `density` given beside it replaces the file's"});
  add_key(s, "material",
          {.name = "frame",
           .accepts = kText,
           .fallback = "\"mesh\"",
           .choices = {"mesh", "scaled", "placed"},
           .meaning = "coordinates of the body in which the file's mesh lies: `mesh` those of its own mesh file, so "
                      "that the material follows the body however it is placed; `scaled` after `scale`, for a mesh "
                      "in millimetres and a material in metres; `placed` after rotate and translate, too",
           .reason = "the material was fitted on the mesh of the body"});
  add_key(s, "material",
          {.name = "hash",
           .accepts = kText,
           .meaning = "of the material's file; written into resolved scenes and then checked"});
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

  s.sections.push_back({"field", "in place of a number of a material", "A value per tet from a table or a file."});
  add_key(s, "field",
          {.name = "regions",
           .accepts = kAnyTable,
           .meaning = "a number for each region label of the mesh: { 1 = 1e5, 2 = 3e5 }"});
  add_key(s, "field",
          {.name = "file",
           .accepts = kText,
           .required = true,
           .meaning = "a CSV file with one number per tet, or a VTU file"});
  add_key(s, "field", {.name = "name", .accepts = kText, .meaning = "the cell field of a VTU file"});
  add_key(s, "field",
          {.name = "hash",
           .accepts = kText,
           .meaning = "of the file's contents; written into resolved scenes and then checked"});
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
    return s;
  }();
  return schema;
}

}  // namespace aspic
