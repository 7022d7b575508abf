#include "aspic/lecture/lessons.h"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <optional>

#include "aspic/lecture/course.h"
#include "base/error.h"
#include "viewer/surface.h"

namespace aspic::cli::lecture {
namespace {

using viewer::Lesson;

// Cursor positions over time, relative to the grabbed highest point of the body.
struct RecordedDrag {
  struct Key {
    double time;   // [s]
    Vec3d offset;  // [m]
  };
  std::vector<Key> keys;
  double until = 0;      // end of the recording [s]
  double stiffness = 0;  // [N/m]; 0: default
};

enum class Shape { of_the_scene, real_mesh };

// Viewer settings of a demonstration.
struct Staging {
  const char* demonstration;  // its key
  const char* part = "";      // appended to the title if a demonstration has several lessons
  const char* exercise;       // includes one thing to try
  const char* question;       // for the reader
  const char* answer;
  const char* panel = "energy";
  const char* scene = "";  // scene of scenes/lecture; empty: none
  bool is_log = false;     // logarithmic energies, because one side explodes
  const char* field = "";  // field for colors
  Shape shape = Shape::real_mesh;
  std::vector<std::string> overrides = {};
  std::vector<Lesson::Comparison> comparison = {};
  std::optional<RecordedDrag> drag = {};
  nlohmann::json function = nullptr;
};

nlohmann::json question(const char* name, double x, double y, nlohmann::json settings) {
  return {{"name", name}, {"start", {x, y}}, {"settings", std::move(settings)}, {"iteration", 0}, {"samples", 61}};
}

// Path of the cursor on pages 33 and 34, as in scenes/lecture/33_mouse.toml.
RecordedDrag wild_drag() {
  return {.keys = {{0, {{0, 0, 0}}},
                   {0.07, {{0.5, -0.1, 0}}},
                   {0.14, {{-0.5, 0.1, 0.3}}},
                   {0.21, {{0.5, -0.4, -0.3}}},
                   {0.28, {{-0.5, 0.2, 0.2}}},
                   {0.35, {{0.5, -0.4, -0.2}}},
                   {0.42, {{0, 0, 0}}}},
          .until = 0.6,
          .stiffness = 1e6};
}

// Path of the cursor on page 25, as in scenes/lecture/25_drag.toml.
RecordedDrag slow_drag() {
  return {.keys = {{0, {{0, 0, 0}}}, {0.3, {{0.25, 0, 0}}}, {0.5, {{0.25, 0.1, 0.1}}}, {0.8, {{0, 0, 0.1}}}},
          .until = 1.5};
}

const std::vector<Staging>& stagings() {
  static const std::vector<Staging> list = {
      {.demonstration = "01_cape",
       .exercise =
           "Play: the gusts lift the cape, and it falls back against the figure. Drag a corner of the hem with the "
           "mouse. In the settings, set body.cape.shell.moment to 2e-3, and play again.",
       .question = "Which of the two energies of the cape, of stretching or of bending, decides how many folds it has?",
       .answer =
           "Their ratio. Stretching is a thousand times stiffer, so that the cape bends wherever it can; the more it "
           "resists bending, the fewer and wider are its folds.",
       .scene = "01_cape",
       .shape = Shape::of_the_scene},
      {.demonstration = "02_fine_mesh",
       .exercise =
           "The thin wires are the edges of tets at the surface: come closer to see them. So that it moves while you "
           "watch, this mesh has fewer tets than the slide's; aspic lecture 2 simulates more than 100 000. Press S, "
           "and choose the chart \"Time by stage over the iterations\": it shows the wall time of the step.",
       .question = "Which stage of a step grows fastest when the mesh gets finer: assembly or the linear solve?",
       .answer = "The linear solve. Assembly grows in proportion to the tets; the factorization of a mesh of n "
                 "vertices in space takes about n^2 operations.",
       .panel = "microscope",
       .scene = "02_fine_mesh"},
      {.demonstration = "03_tissue",
       .exercise =
           "The colors show Young's modulus: stiff skin over soft fat over muscle. Play: the indenter sinks in, and "
           "the energy V in the plot grows faster than the square of its depth because the tissue stiffens. Color "
           "by von Mises stress to see where it is loaded. In aspic view scenes/bench.toml, the tab Bench measures a "
           "body with an indenter of your own.",
       .question = "The indenter sinks twice as deep. Does V become four times as large?",
       .answer = "More than that. V of a linear material grows with the square of the depth; this tissue stiffens "
                 "under compression.",
       .scene = "03_tissue",
       .field = "young",
       .shape = Shape::of_the_scene},
      {.demonstration = "05-09_equation_of_motion",
       .exercise = "Play: V falls while T rises, and vice versa, as M q'' = -dV/dq exchanges them. Shift and click "
                   "on a vertex to read where its three entries are in q.",
       .question = "At which moments is T largest?",
       .answer = "When V is smallest: T + V changes only by what the integrator dissipates.",
       .scene = "05_swing"},
      {.demonstration = "06_chutes",
       .exercise =
           "Play: the bodies fall on the chutes, slide and tumble to the floor. Dots are contact points, colored by "
           "pressure. Drag a body against the other, or up a chute: nothing intersects. The energy plot has a curve "
           "for contact.",
       .question = "Why does no surface ever pass through another, although nothing is corrected afterwards?",
       .answer = "The barrier is infinite where surfaces touch, so no minimizer touches; and every iterate moves only "
                 "as far as no two surfaces meet on the way.",
       .scene = "06_chutes"},
      {.demonstration = "08-10_springs_beside_elements",
       .exercise =
           "Play, then drag each: elements on the left, springs along the edges on the right, on the same mesh. Both "
           "obey the same equation with another V. Springs do not resist changes of volume and sag differently.",
       .question = "On what does V depend in each of the two meshes?",
       .answer = "Springs: on the lengths of the edges only. Elements: on the deformation gradient F of each tet, and "
                 "so on its change of volume det F.",
       .scene = "08_springs_beside_elements"},
      {.demonstration = "10-18_differences",
       .exercise =
           "The same motion in steps of h and of h/2: differences of q approximate its derivatives, more "
           "accurately for shorter steps. Play and see how the two bodies drift apart, and how much more T the shorter "
           "steps keep.",
       .question = "What happens to the errors of (q_i - q_(i-1)) / h and of the second difference when h is halved?",
       .answer = "The error of the first halves, that of the second falls to a quarter at t_i, because it is symmetric "
                 "about it.",
       .scene = "05_swing",
       .comparison = {{{"time.step=0.005"}, "h / 2"}}},
      {.demonstration = "19-22_explicit_or_implicit",
       .exercise =
           "With steps this short both schemes give the same motion; where dV/dq is evaluated hardly matters. Make h "
           "ten times as long and play again: only one of them stays stable.",
       .question = "Both schemes share M, q~ and V. What makes only one of them unstable for long steps?",
       .answer = "The explicit scheme extrapolates the force at q_i. A vibration of angular frequency w grows if h > 2 "
                 "/ w; the implicit force at q_(i+1) always opposes it.",
       .scene = "05_swing",
       .shape = Shape::of_the_scene,
       .overrides = {"time.step=5e-4", "solver.mass=lumped"},
       .comparison = {{{"time.integrator=symplectic_euler"}, "explicit"}}},
      {.demonstration = "23_printed_forward_euler",
       .exercise =
           "Play: A is the printed formula, which is symplectic Euler, B the classical forward Euler, both with "
           "the same h. T + V of the printed one stays in a band, that of the classical one grows until it explodes.",
       .question = "Where do the two formulas evaluate dV/dq?",
       .answer = "The printed one at q_i, the classical one at q_(i-1). The force that is late by one step adds energy "
                 "to every vibration.",
       .scene = "05_swing",
       .shape = Shape::of_the_scene,
       .overrides = {"time.step=5e-4", "solver.mass=lumped", "time.integrator=symplectic_euler", "gravity=[0, 0, 0]"},
       .comparison = {{{"time.integrator=forward_euler"}, "classical"}}},
      {.demonstration = "24_backward_euler",
       .exercise = "Play: A is backward Euler, B the explicit scheme with the same h = 0.01 s. The explicit one "
                   "explodes within "
                   "a few steps; backward Euler needs a minimization per step and dissipates energy.",
       .question = "What is the price of this stability?",
       .answer =
           "A minimization per step, and numerical damping: T + V falls although the equation dissipates nothing.",
       .scene = "05_swing",
       .is_log = true,
       .overrides = {"gravity=[0, 0, 0]"},
       .comparison = {{{"time.integrator=symplectic_euler"}, "explicit"}}},
      {.demonstration = "25_drag",
       .exercise =
           "A recorded mouse pulls the highest point by a spring: the line shows the spring, the number its force. "
           "Take over at any time and pull; the energy plot shows the work of the mouse.",
       .question = "Where does the energy of the body come from?",
       .answer = "From the work of the mouse, the force of the spring times the motion of the cursor. It equals the "
                 "gain of energy plus the losses.",
       .scene = "25_drag",
       .overrides = {"spring=[]"},
       .drag = slow_drag()},
      {.demonstration = "26-31_optimization",
       .exercise =
           "Take single steps and choose an iteration: the gradient of E is the residual of the equation. Where it "
           "is zero, E has its minimum and the equation holds.",
       .question = "Is every point where the gradient of E is zero a minimum?",
       .answer = "No, V is not convex: it may be a saddle or a maximum. For short steps the term with M dominates and "
                 "E is convex; then the solution is unique.",
       .panel = "microscope",
       .scene = "05_swing"},
      {.demonstration = "32_one_minimization_per_step",
       .exercise = "Take one iteration at a time: the body moves a little and E falls at a fixed time. The step "
                   "is complete when the minimization has converged.",
       .question = "What changes in E from one step to the next?",
       .answer = "q~, which moves the minimum of the inertia term; V changes only by moving pins and loads.",
       .panel = "microscope",
       .scene = "05_swing"},
      {.demonstration = "33-34_explosion",
       .part = "explicit",
       .exercise =
           "The same mouse drags both: A is implicit, B explicit. The explicit scheme explodes within a few "
           "steps and ends; the implicit one continues, and stays stable: take over and pull as hard as you can.",
       .question = "The implicit scheme is stable for every h. Is it also accurate?",
       .answer =
           "No. Stable means that errors do not grow; long steps still damp the motion. Make h shorter and compare.",
       .scene = "33_mouse",
       .is_log = true,
       .overrides = {"spring=[]"},
       .comparison = {{{"time.integrator=symplectic_euler"}, "explicit"}},
       .drag = wild_drag()},
      {.demonstration = "33-34_explosion",
       .part = "linearized",
       .exercise =
           "The same mouse drags both: A solves one minimization per step, B one linear system per step. Where the "
           "body bends far, the linear system is inaccurate and the energy grows. Halve h and reset: how far does "
           "it come now?",
       .question = "How is the linearized scheme related to Newton's method?",
       .answer =
           "It is the first iteration with the full step, without a line search and without a test of the residual.",
       .scene = "33_mouse",
       .is_log = true,
       .overrides = {"spring=[]"},
       .comparison = {{{"time.integrator=linearly_implicit_euler"}, "linearized"}},
       .drag = wild_drag()},
      {.demonstration = "36-40_velocity_form",
       .exercise =
           "Choose an iteration: with q = q_i + h v the same E is a function of the velocities, its minimum the same "
           "motion. Only the labels of the axes would change.",
       .question = "The first form has h^2 in front of V, this one does not. Why is the motion the same?",
       .answer = "Because q - q~ = h (v - v_i), E(q) = h^2 E(v). A constant factor does not move the minimum.",
       .panel = "microscope",
       .scene = "05_swing"},
      {.demonstration = "38-42_gradient_descent",
       .part = "Rosenbrock's valley",
       .exercise = "Each step follows the steepest descent across the valley, so the path zig-zags. 200 "
                   "iterations are not enough. Drag the start elsewhere, or choose Newton's method for the same start.",
       .question = "Why do successive steps turn by a right angle or more?",
       .answer = "A step ends where E has stopped falling along its direction, or beyond. There the gradient has no "
                 "component along that direction, or one that points back.",
       .panel = "functions",
       .function = question("rosenbrock", -1, -0.5, {{"method", "gradient_descent"}})},
      {.demonstration = "38-42_gradient_descent",
       .part = "two bumps",
       .exercise =
           "Where the level lines are nearly circles the gradient points at the minimum and a few dozen iterations "
           "are enough. Drag the start to the other side of the bump and compare the paths.",
       .question = "Which number decides how fast gradient descent converges near a minimum?",
       .answer = "The condition number of the Hessian, its largest divided by its smallest eigenvalue. It is 1 if the "
                 "level lines are circles.",
       .panel = "functions",
       .function = question("two_bump", -0.3, 0.9, {{"method", "gradient_descent"}})},
      {.demonstration = "38-42_gradient_descent",
       .part = "a step of a body",
       .exercise =
           "Play: A is Newton's method, B gradient descent on the same steps, to the same tolerance. Compare the "
           "number of iterations and the time that each step takes.",
       .question = "An iteration of gradient descent is cheaper. Why does its step take longer?",
       .answer = "It needs far more iterations: stiff and soft deformations together make the condition number of the "
                 "Hessian large.",
       .panel = "microscope",
       .scene = "05_swing",
       .shape = Shape::of_the_scene,
       .overrides = {"solver.tolerance=1e-3", "solver.max_iterations=20000"},
       .comparison = {{{"solver.method=gradient_descent"}, "gradient descent"}}},
      {.demonstration = "43-51_quadratic_model",
       .exercise = "The second surface is the quadratic model: it touches E at the iterate and has the same slope and "
                   "curvature there. Newton's step goes to the model's lowest point; step through the iterations.",
       .question = "For which E is one iteration of Newton's method enough?",
       .answer = "For a quadratic E with a positive definite Hessian: the model is then E itself.",
       .panel = "functions",
       .function = question("rosenbrock", -0.8, 0.3, {{"method", "newton"}})},
      {.demonstration = "53+62_pure_newton",
       .exercise = "Take one step (S): A is Newton's method with a line search, B without. The E of A falls in every "
                   "iteration. Choose B above the table: its E jumps far up in the first iteration, the iterates end "
                   "outside the range "
                   "of numbers, and the body stays squashed because its step has no result.",
       .question = "Both start at the same point with the same direction. Why does E rise without a line search?",
       .answer = "The model is accurate only near the iterate. The full step leaves this region and inverts tets; a "
                 "shorter one does not.",
       .panel = "microscope",
       .scene = "53_hard_step",
       .comparison = {{{"solver.line_search.test=none"}, "without line search"}}},
      {.demonstration = "54-59_overshoot",
       .exercise =
           "The minimum of the model is E = 0, but the true E there is a hundred times as high as at the start. "
           "A quarter of the same step lies lower: the line search finds it. Drag the start along the valley to "
           "where the full step succeeds.",
       .question = "Why does a short enough step along this direction always lower E?",
       .answer =
           "The slope of E along d is d'g = -d'H d, which is negative if H is positive definite: E falls at first.",
       .panel = "functions",
       .function = question("rosenbrock", 0, 0, {{"method", "newton"}})},
      {.demonstration = "60-61_backtracking",
       .exercise =
           "Take one step and choose an iteration with several trials: those above the line are rejected, alpha "
           "shrinks by p until one lies below. Change \u03b1_max, c and p in the settings, Line search, and step "
           "again.",
       .question = "What happens for c = 0, and for c > 1/2?",
       .answer = "c = 0 accepts any decrease, however small, so the iterates may stall. c > 1/2 rejects Newton's full "
                 "step even on a quadratic E, which lowers E by half of its slope.",
       .panel = "microscope",
       .scene = "53_hard_step"},
  };
  return list;
}

Vec3d offset_at(const RecordedDrag& drag, double time) {
  const auto next =
      std::find_if(drag.keys.begin(), drag.keys.end(), [&](const RecordedDrag::Key& k) { return k.time > time; });
  if (next == drag.keys.end()) return drag.keys.back().offset;
  const RecordedDrag::Key& last = *(next - 1);
  const double part = (time - last.time) / (next->time - last.time);
  return (1 - part) * last.offset + part * next->offset;
}

nlohmann::json to_json(const Vec3d& x) { return {x[0], x[1], x[2]}; }

// Recorded mouse: grabs the highest point, moves once per step and releases it.
std::string recording_of(const RecordedDrag& drag, const std::filesystem::path& path,
                         const std::vector<std::string>& overrides) {
  const Scene scene = load_scene(path, {.overrides = overrides});
  const viewer::Surface surface = viewer::boundary_of(scene.simulation.model());
  const Vec3d top = *std::max_element(surface.rest.begin(), surface.rest.end(),
                                      [](const Vec3d& a, const Vec3d& b) { return a[1] < b[1]; });
  const viewer::SurfacePoint point = viewer::nearest_surface_point(surface, top);
  const double h = scene.simulation.options().h;
  const auto step_at = [&](double time) { return 1 + static_cast<int>(std::lround(time / h)); };

  nlohmann::json events = nlohmann::json::array();
  const auto add = [&](int step, nlohmann::json command) {
    events.push_back({{"step", step}, {"command", std::move(command)}});
  };
  if (drag.stiffness > 0) add(1, {{"do", "stiffness"}, {"value", drag.stiffness}});
  add(1, {{"do", "grab"},
          {"side", "a"},
          {"triangle", point.triangle},
          {"weights", to_json(point.weights)},
          {"target", to_json(top)}});
  const int released = step_at(drag.keys.back().time);
  for (int step = 2; step <= released; ++step)
    add(step, {{"do", "move"}, {"target", to_json(top + offset_at(drag, step * h))}});
  add(released + 1, {{"do", "release"}});
  return nlohmann::json{{"scene", path.string()},
                        {"overrides", overrides},
                        {"compare", nullptr},
                        {"events", std::move(events)},
                        {"steps", step_at(drag.until) - 1}}
      .dump();
}

// Location of the scenes; `why_not` if they are missing.
struct Place {
  std::optional<Stage> stage;
  std::vector<std::string> real_mesh;
  std::string why_not;
};

Place find_place(const std::filesystem::path& cache) {
  Place place;
  try {
    place.stage.emplace("", cache);
    place.real_mesh = place.stage->real_mesh();
  } catch (const InvalidInput& error) {
    place.why_not = error.what();
    place.stage.reset();
  }
  return place;
}

void set_scene(const Staging& staging, const Place& place, Lesson& lesson) {
  if (!place.stage) {
    lesson.missing = place.why_not;
    return;
  }
  lesson.scene = place.stage->path_of(staging.scene);
  if (staging.shape == Shape::real_mesh) lesson.overrides = place.real_mesh;
  lesson.overrides.insert(lesson.overrides.end(), staging.overrides.begin(), staging.overrides.end());
  lesson.comparison = staging.comparison;
  lesson.field = staging.field;
  if (staging.drag)
    lesson.recording = [drag = *staging.drag, path = lesson.scene, overrides = lesson.overrides] {
      return recording_of(drag, path, overrides);
    };
}

Lesson lesson_of(const Demonstration& demonstration, const Staging& staging, const Place& place) {
  const std::string part = staging.part;
  Lesson lesson{.id = demonstration.key + (part.empty() ? "" : "_" + part),
                .pages = pages_text(demonstration.pages),
                .title = demonstration.title + (part.empty() ? "" : ": " + part),
                .claim = demonstration.claim,
                .exercise = staging.exercise,
                .question = staging.question,
                .answer = staging.answer,
                .panel = staging.panel,
                .is_log = staging.is_log};
  if (!staging.function.is_null()) lesson.function = staging.function.dump();
  if (*staging.scene) set_scene(staging, place, lesson);
  return lesson;
}

}  // namespace

std::vector<Lesson> lessons(const std::filesystem::path& cache) {
  const Place place = find_place(cache);
  std::vector<Lesson> list;
  for (const Demonstration& demonstration : demonstrations())
    for (const Staging& staging : stagings())
      if (staging.demonstration == demonstration.key) list.push_back(lesson_of(demonstration, staging, place));
  return list;
}

}  // namespace aspic::cli::lecture
