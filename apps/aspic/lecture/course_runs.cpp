// The computations of the demonstrations; course.cpp has their texts.
#include <map>
#include <string_view>

#include "aspic/lecture/course.h"

namespace aspic::cli::lecture {
namespace {

using Computation = void (*)(const Stage&, Sheet&);

const std::map<std::string_view, Computation>& computations() {
  static const std::map<std::string_view, Computation> map = {
      {"01_cape", show_cape},
      {"02_fine_mesh", show_fine_mesh},
      {"03_tissue", show_tissue},
      {"05-09_equation_of_motion", show_equation_of_motion},
      {"06_chutes", show_chutes},
      {"08-10_springs_beside_elements", show_springs_beside_elements},
      {"10-18_differences", show_differences},
      {"19-22_explicit_or_implicit", show_explicit_or_implicit},
      {"23_printed_forward_euler", show_printed_forward_euler},
      {"24_backward_euler", show_backward_euler},
      {"25_drag", show_drag},
      {"26-31_optimization", show_optimization},
      {"32_one_minimization_per_step", show_one_minimization_per_step},
      {"33-34_explosion", show_explosion},
      {"36-40_velocity_form", show_velocity_form},
      {"38-42_gradient_descent", show_gradient_descent},
      {"43-51_quadratic_model", show_quadratic_model},
      {"53+62_pure_newton", show_pure_newton},
      {"54-59_overshoot", show_overshoot},
      {"60-61_backtracking", show_backtracking},
  };
  return map;
}

}  // namespace

void run_demonstration(const Demonstration& demonstration, const Stage& stage, Sheet& sheet) {
  computations().at(demonstration.key)(stage, sheet);
}

}  // namespace aspic::cli::lecture
