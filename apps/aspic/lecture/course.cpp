#include "aspic/lecture/course.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace aspic::cli::lecture {
namespace {

std::vector<int> range(int first, int last) {
  std::vector<int> pages(last - first + 1);
  std::iota(pages.begin(), pages.end(), first);
  return pages;
}

}  // namespace

const std::vector<Demonstration>& demonstrations() {
  static const std::vector<Demonstration> list = {
      {"01_cape",
       {1},
       "a cape in the wind",
       "A cape hangs from the shoulders of a walking figure and flutters in gusts: a sheet of triangles whose V is "
       "that of stretching and bending. Drag and contact are further terms of the same minimization."},
      {"02_fine_mesh",
       {2},
       "a very fine mesh",
       "A mesh of very many tets can be simulated, and drawn shaded with thin wires."},
      {"03_tissue",
       {3},
       "soft tissue in layers",
       "Capture and modeling of non-linear heterogeneous soft tissue [Bickel et al. 2009]: a slab of layers is poked "
       "and "
       "the force is measured. Here the layers' moduli are given; aspic capture records such pokes of a body, and "
       "aspic fit estimates its stiffness from them."},
      {"05-09_equation_of_motion",
       {5, 7, 8, 9},
       "the equation of motion",
       "M q'' = -dV/dq; q stacks the positions of the vertices of a finite element mesh."},
      {"06_chutes",
       {6},
       "bodies tumble down chutes",
       "Soft bodies fall on chutes and slide down. Contact is one more summand of V: a barrier energy kappa w b(d) for "
       "each point of area w at a distance d < r, infinite where surfaces touch, so that the minimizer never "
       "intersects."},
      {"08-10_springs_beside_elements",
       {8, 10},
       "masses and springs beside finite elements",
       "The same equation moves a mesh of masses and springs of rest length l_ab along its edges, and one of tets T; "
       "four vertices are shown with their entries of q."},
      {"10-18_differences", range(10, 18), "finite differences of q",
       "qdot = (q_i - q_(i-1)) / h, q'' = (q_(i+1) - 2 q_i + q_(i-1)) / h^2, "
       "q~ = 2 q_i - q_(i-1) = q_i + h qdot_i (the slide misprints the sign under the brace)."},
      {"19-22_explicit_or_implicit", range(19, 22), "explicit or implicit",
       "M (q_(i+1) - q~) / h^2 = -dV/dq, evaluated at q_i (explicit) or at q_(i+1) (implicit)."},
      {"23_printed_forward_euler",
       {23},
       "the slide's \"forward Euler\"",
       "q_(i+1) = 2 q_i - q_(i-1) - h^2 M^-1 dV/dq(q_i), printed as \"Forward Euler\": it is symplectic Euler."},
      {"24_backward_euler",
       {24},
       "backward Euler",
       "q_(i+1) = 2 q_i - q_(i-1) - h^2 M^-1 dV/dq(q_(i+1)): more stable, harder to solve."},
      {"25_drag",
       {25},
       "dragged by the ear",
       "A spring between a point x of an ear and the cursor c bends the ear; the spring's force f is shown."},
      {"26-31_optimization", range(26, 31), "from finding a root to minimizing",
       "M (q - q~) + h^2 dV/dq = 0 is the gradient of E(q) = 1/2 (q - q~)' M (q - q~) + h^2 V(q)."},
      {"32_one_minimization_per_step",
       {32},
       "for each time step, use optimization",
       "q_(i+1) = argmin E(q), once for each time step."},
      {"33-34_explosion",
       {33, 34},
       "explicit and linearized schemes explode",
       "Dragged by the same motion, the explicit and the linearized scheme explode; the implicit one is stable."},
      {"36-40_velocity_form", range(36, 40), "the same in velocities",
       "E(v) = 1/2 (v - v_i)' M (v - v_i) + V(q_i + h v) with q = q_i + h v: the same problem."},
      {"38-42_gradient_descent", range(38, 42), "the loop, and gradient descent",
       "Choose a guess; repeat until converged: choose a direction d, a step length, move. d = -gradient zig-zags."},
      {"43-51_quadratic_model", range(43, 51), "Newton's method",
       "E(x + d) ~ E + g'd + 1/2 d'H d; its minimizer solves H d = -g; g and H of E(v) are M (v - v_i) + h dV/dq and "
       "M + h^2 d2V/dq2."},
      {"53+62_pure_newton",
       {53, 62},
       "Newton without and with a line search",
       "Newton's method without a line search fails on a step of a real mesh (53); with one it succeeds (62)."},
      {"54-59_overshoot", range(54, 59), "Newton overshoots",
       "The minimizer of the model may lie higher than the start; a shorter step along the same direction lies lower."},
      {"60-61_backtracking",
       {60, 61},
       "backtracking line search",
       "alpha = alpha_max; while E(x + alpha d) > E + c alpha d'g (printed without alpha): alpha = p alpha; shorter "
       "than tol, or you get stuck."},
  };
  return list;
}

std::vector<const Demonstration*> demonstrations_of(int page) {
  std::vector<const Demonstration*> found;
  for (const Demonstration& d : demonstrations())
    if (std::binary_search(d.pages.begin(), d.pages.end(), page)) found.push_back(&d);
  return found;
}

std::string pages_text(const std::vector<int>& pages) {
  std::string text;
  for (size_t i = 0; i < pages.size();) {
    size_t j = i;
    while (j + 1 < pages.size() && pages[j + 1] == pages[j] + 1) ++j;
    text += fmt::format("{}{}", text.empty() ? "" : ", ", pages[i]);
    if (j > i) text += fmt::format("-{}", pages[j]);
    i = j + 1;
  }
  return text;
}

std::string reason_for_none(int page) {
  return demonstrations_of(page).empty() ? "neither a formula nor a demonstration" : "";
}

}  // namespace aspic::cli::lecture
