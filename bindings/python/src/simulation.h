// A simulation, and what it was made from.
#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "arrays.h"
#include "callbacks.h"
#include "dynamics/pins.h"
#include "function.h"
#include "occupancy.h"
#include "results/run_directory.h"
#include "scene/scene.h"
#include "scene/scene_model.h"
#include "scene/value.h"

namespace aspic::python {

// A file with overrides or a document, and terms of V in Python. It can be built several times.
class SceneSource {
 public:
  SceneSource(std::filesystem::path path, std::vector<std::string> overrides, std::vector<py::object> energies);
  SceneSource(const py::dict& document, std::string name, std::vector<py::object> energies);

  void check_keys() const;  // of the file and the overrides. Throws InvalidInput
  // Builds the model without energies. Throws InvalidInput. Returns false if it has more tets, which takes too long.
  bool check_model(double most_tets) const;
  bool has_energies() const { return !energies_.empty(); }
  // Require the GIL, and release it. Throw InvalidInput and what the energies raise.
  Scene scene(const std::shared_ptr<Callbacks>& callbacks) const;
  SceneModel model(const std::shared_ptr<Callbacks>& callbacks) const;

 private:
  template <class Build>
  auto build(const Build& build, const std::shared_ptr<Callbacks>& callbacks) const;

  std::filesystem::path path_;
  std::vector<std::string> overrides_;
  std::optional<Table> document_;  // checked and complete
  std::string name_;
  std::vector<py::object> energies_;
};

// A step with the names of its values and what its explanation needs.
struct Report : StepReport {
  std::vector<std::string> potential_names, pin_names, load_names, body_names, cavity_names;
  std::string cause, place, remedy;  // of a failure
};
Report named(const StepReport& report, const Simulation& simulation);  // with the names, and in the numbers of the user
void bind_report(py::module_& m);

class LiveSimulation {
 public:
  explicit LiveSimulation(std::shared_ptr<const SceneSource> source);

  // Takes one step. The state stays after an exception, Ctrl-C, and if `observe` returns False. None: the direction and
  // the line search of the scene.
  Report step(const py::object& observe, const py::object& direction, const py::object& line_search);
  // Records the steps from now on. `is_compact`: only the motion of the surfaces, and the tables.
  void record(const std::filesystem::path& folder, bool is_compact, bool overwrite);
  void flush();  // writes indices and the last checkpoint of the recording
  bool is_recording() const { return recording_.has_value(); }
  void end_recording() { recording_.reset(); }
  void restore(const Simulation::Snapshot& snapshot);

  const Scene& scene() const { return check_idle(), scene_; }
  Simulation& simulation() { return check_idle(), scene_.simulation; }
  const SceneSource& source() const { return *source_; }
  Layout layout() const;      // of vertices
  Layout row_layout() const;  // of the rows of an objective: vertices, then angles of shells

 private:
  // Throws std::runtime_error if another thread takes a step or writes results.
  void check_idle() const;
  void set_method(const py::object& direction, const py::object& line_search);
  StepReport take_step(const IterationObserver& observe);

  std::shared_ptr<const SceneSource> source_;
  std::shared_ptr<Callbacks> callbacks_ = std::make_shared<Callbacks>();
  Scene scene_;
  SolverOptions solver_;  // of the scene
  Pins pins_;
  py::object direction_ = py::none(), line_search_ = py::none();  // in use
  std::optional<RunDirectory> recording_;
  bool is_stepping_ = false;  // guarded by the GIL
  Occupancy occupancy_;
};

}  // namespace aspic::python
