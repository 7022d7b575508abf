// The lecture "From Energy to Motion": its 62 pages and their demonstrations.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "aspic/lecture/sheet.h"
#include "scene/scene.h"

namespace aspic::cli::lecture {

inline constexpr int kPages = 62;

// Provides scenes and meshes.
class Stage {
 public:
  // `mesh`: tets or closed surface for demonstrations on a real mesh; empty: the bunny if available. `cache` stores
  // meshes that take long to make. Throws InvalidInput if the scenes of the lecture are missing.
  Stage(const std::filesystem::path& mesh, std::filesystem::path cache);

  // Returns a scene of scenes/lecture with its own shape.
  Scene scene(const std::string& name, const std::vector<std::string>& overrides = {}) const;
  // Returns the scene with the real mesh, scaled to one meter, as its bodies; without a real mesh, with its own shape.
  Scene on_real_mesh(const std::string& name, const std::vector<std::string>& overrides = {}) const;
  // Returns the scene with a mesh of at least `tets` tets.
  Scene on_fine_mesh(const std::string& name, int tets, Sheet& sheet) const;

  std::filesystem::path path_of(const std::string& name) const;  // file of a scene of scenes/lecture
  std::vector<std::string> real_mesh() const;                    // overrides that on_real_mesh() adds

  const std::string& mesh_note() const { return note_; }  // selected mesh, and the reason

 private:
  Scene load(const std::string& name, const std::filesystem::path& mesh, std::vector<std::string> overrides) const;
  std::filesystem::path finer(int tets) const;

  std::filesystem::path scenes_, mesh_, surface_, cache_;
  std::string note_;
};

struct Demonstration {
  std::string key;         // folder name, "10-18_differences"
  std::vector<int> pages;  // ascending
  std::string title;
  std::string claim;  // claim of the slides, with formulas
};
const std::vector<Demonstration>& demonstrations();
std::vector<const Demonstration*> demonstrations_of(int page);
std::string pages_text(const std::vector<int>& pages);  // "5, 7-9"

void run_demonstration(const Demonstration& demonstration, const Stage& stage, Sheet& sheet);

// Returns why a page has no demonstration; empty if it has one.
std::string reason_for_none(int page);

// The demonstrations, by file.
void show_cape(const Stage& stage, Sheet& sheet);
void show_fine_mesh(const Stage& stage, Sheet& sheet);
void show_tissue(const Stage& stage, Sheet& sheet);
void show_equation_of_motion(const Stage& stage, Sheet& sheet);
void show_chutes(const Stage& stage, Sheet& sheet);
void show_springs_beside_elements(const Stage& stage, Sheet& sheet);
void show_differences(const Stage& stage, Sheet& sheet);
void show_explicit_or_implicit(const Stage& stage, Sheet& sheet);
void show_printed_forward_euler(const Stage& stage, Sheet& sheet);
void show_backward_euler(const Stage& stage, Sheet& sheet);
void show_drag(const Stage& stage, Sheet& sheet);
void show_optimization(const Stage& stage, Sheet& sheet);
void show_one_minimization_per_step(const Stage& stage, Sheet& sheet);
void show_explosion(const Stage& stage, Sheet& sheet);
void show_velocity_form(const Stage& stage, Sheet& sheet);
void show_gradient_descent(const Stage& stage, Sheet& sheet);
void show_quadratic_model(const Stage& stage, Sheet& sheet);
void show_pure_newton(const Stage& stage, Sheet& sheet);
void show_overshoot(const Stage& stage, Sheet& sheet);
void show_backtracking(const Stage& stage, Sheet& sheet);

}  // namespace aspic::cli::lecture
