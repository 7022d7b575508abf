// Summary of a run, and hints to view its results.
#pragma once
#include <array>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "dynamics/simulation.h"
#include "dynamics/step_report.h"

namespace aspic::cli {

struct RunTotals {
  int steps = 0, unconverged = 0;
  int out_of_time = 0;  // ended by solver.time_budget as requested; not counted as unconverged
  std::array<int, kStatusCount> by_status = {};
  int bounds_held = 0, bounds_broken = 0;  // energy bounds, where backward Euler guarantees one
  int grew = 0;           // steps with such a bound in which kinetic + potential grew by more than the work of forces
  double most_grown = 0;  // [J]
  std::optional<StepReport> worst;  // least successful, then largest residual over threshold
  long iterations = 0;
  long values = 0, gradients = 0, hessians = 0, factorizations = 0, products = 0, cycles = 0;
  int most_iterations = 0;
  long substeps = 0, rejected = 0;                 // substeps of adaptive steps
  double seconds = 0;                              // total of the steps
  double time = 0;                                 // end of the last step [s]
  int with_inverted_tets = 0, first_inverted = 0;  // steps that end with an inverted tet: number, first
  double least_det_F = 1;                          // over all tets at the ends of steps
  double gap_error = 0, contact_force_error = 0;   // maxima, see StepReport
  double numerical_loss = 0;                       // sum over the steps [J]
  double driven_work = 0;                          // of pins, targets and obstacles, sum over the steps [J]
  double most_kinetic = 0;                         // maximum of the kinetic energy, with the loss of the step [J]
  double first_potential = 0;                      // potential energy after the first step [J]
  double most_changed = 0;                         // largest difference from it [J]
  std::vector<Resultant> reactions;                // reaction of each pin in the last step
  std::string mesh_error;                          // the last one in words; empty: none was computed

  void add(const StepReport& report);
};

struct InvertedTets {
  int count = 0;               // number of tets with det F <= 0
  double least_det = 1;        // smallest det F of all tets
  std::string worst;           // tet with this value, and its position: "tet 12 at (0, 0.1, 0.2) m"
  bool are_quadratic = false;  // whether there are quadratic tets
};
InvertedTets inverted_tets(const Simulation& simulation);

struct RunEnd {
  int last_step = 0, steps_taken = 0;
  bool interrupted = false;
  double time_limit = 0;  // limit that ended the run [s]; 0: none
  bool blown_up = false;
  std::string solver;                    // methods, their choices and the reasons; empty: no solver
  std::string precision;                 // see precision_of()
  std::string start_warning;             // see Scene::start_warning
  std::string better_scheme;             // integrator that loses less energy; empty: none
  std::optional<InvertedTets> inverted;  // in the last state, if it is known
  std::uint64_t state_hash = 0;          // hash of the last state
  std::vector<std::string> untouched;    // obstacles that no body touched at the end of a step
  std::vector<std::string> pins;         // names of RunTotals::reactions; empty: no force
  std::filesystem::path directory;
  std::string program = "aspic";  // that continues the run
};

// Returns what `converged` means where it is no residual: " to 0.001 m/s".
std::string precision_of(const MinimizeOptions& options);
void print_summary(std::FILE* stream, const RunTotals& totals, const RunEnd& end);

}  // namespace aspic::cli
