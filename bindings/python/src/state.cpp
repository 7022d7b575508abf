#include "state.h"

#include <algorithm>
#include <vector>

#include "base/error.h"
#include "math/vectors.h"

namespace aspic::python {
namespace {

using Snapshot = Simulation::Snapshot;

constexpr double kRoundOff = 1e-12;  // of positions and velocities, relative to the largest

// Returns the last pin of each vertex, of those with a motion if there are any. Null: none.
std::vector<const Pin*> pins_of_vertices(const Model& model) {
  std::vector<const Pin*> pin_of(static_cast<size_t>(model.rows()));
  for (const Pin& pin : model.pins)
    for (const int v : pin.vertices)
      if (!pin_of[v] || pin.motion) pin_of[v] = &pin;
  return pin_of;
}

std::string entry_of(const char* array, const Model& model, int vertex, const Vec3d& value) {
  return std::string(array) + "[" + std::to_string(model.numbering.vertex.to_user(vertex)) +
         "] = " + point_text(value) + "; the pin '" + pins_of_vertices(model)[vertex]->name + "' ";
}

// Moves the start of fixed vertices, which their pins refer to.
void hold_at(std::span<const double> q, const Model& model, Snapshot& snapshot) {
  const Pins pins(model.pins, snapshot.start.q);
  std::vector<double> prescribed(q.begin(), q.end());
  pins.place(snapshot.state.time, prescribed);
  const std::vector<const Pin*> pin_of = pins_of_vertices(model);
  const double round_off = kRoundOff * max_abs(snapshot.state.q);
  for (int v = 0; v < pins.rows(); ++v) {
    const Vec3d x = vec_at(q, v), now = vec_at(snapshot.state.q, v), target = vec_at(prescribed, v);
    if (norm(x - target) <= round_off) continue;
    if (pin_of[v] && pin_of[v]->motion) {
      if (norm(pins.held_part(v, x - now)) <= round_off) continue;  // as after a dropped step
      throw InvalidInput(entry_of("q", model, v, x) + "prescribes " + point_text(target) +
                         " at this time; change only vertices that no pin moves");
    }
    std::vector<double>& start = snapshot.start.q;
    set_vec(pins.free_part(v, vec_at(start, v)) + pins.held_part(v, x), v, start);
  }
}

void refuse_velocities_of_pins(std::span<const double> velocity, const Model& model, const Snapshot& snapshot) {
  const Pins pins(model.pins, snapshot.start.q);
  const double round_off = kRoundOff * std::max(max_abs(snapshot.state.qdot), max_abs(velocity));
  for (int i = 0; i < pins.rows(); ++i) {
    const Vec3d v = vec_at(velocity, i), now = vec_at(snapshot.state.qdot, i);
    if (norm(pins.held_part(i, v)) <= round_off || norm(pins.held_part(i, v - now)) <= round_off) continue;
    throw InvalidInput(entry_of("v", model, i, v) +
                       "prescribes the motion of this vertex; give it 0 or its value in sim.v");
  }
}

// Appends the angles of shells, which are not in the arrays of Python.
std::vector<double> with_angles(std::vector<double> vertices, const std::vector<double>& rows) {
  vertices.insert(vertices.end(), rows.begin() + static_cast<std::ptrdiff_t>(vertices.size()), rows.end());
  return vertices;
}

void assign(LiveSimulation& simulation, Snapshot snapshot) {
  snapshot.previous.reset();
  simulation.restore(snapshot);
}

Array flat(const std::vector<double>& values) { return to_array(values, {static_cast<py::ssize_t>(values.size())}); }

std::vector<double> numbers_in(const py::handle& values) {
  const Array numbers = reals(values, "snapshot", {-1}, Finite::not_required);
  return {view(numbers).begin(), view(numbers).end()};
}

py::tuple tuple_of(const State& state) {
  return py::make_tuple(flat(state.q), flat(state.qdot), state.time, flat(state.internal));
}

State state_in(const py::tuple& t) {
  return {numbers_in(t[0]), numbers_in(t[1]), t[2].cast<double>(), numbers_in(t[3])};
}

py::tuple tuple_of(const Snapshot& s) {
  const py::object previous = s.previous ? py::object(tuple_of(*s.previous)) : py::none();
  const py::object obstacle_time = s.obstacle_time ? py::object(py::float_(*s.obstacle_time)) : py::none();
  return py::make_tuple(tuple_of(s.state), tuple_of(s.start), s.steps_taken, s.level, previous, obstacle_time,
                        s.outside_work);
}

Snapshot snapshot_in(const py::tuple& t) {
  Snapshot s{state_in(t[0]), state_in(t[1]), t[2].cast<int>(), t[3].cast<double>(), {}, {}, t[6].cast<double>()};
  if (const py::object previous = t[4]; !previous.is_none()) s.previous = state_in(previous);
  if (const py::object time = t[5]; !time.is_none()) s.obstacle_time = time.cast<double>();
  return s;
}

}  // namespace

void set_positions(LiveSimulation& simulation, const py::object& q) {
  Snapshot snapshot = simulation.simulation().snapshot();
  std::vector<double> positions = with_angles(simulation.layout().in(q, "q"), snapshot.state.q);
  hold_at(positions, simulation.simulation().model(), snapshot);
  snapshot.state.q = std::move(positions);
  assign(simulation, std::move(snapshot));
}

void set_velocities(LiveSimulation& simulation, const py::object& v) {
  Snapshot snapshot = simulation.simulation().snapshot();
  std::vector<double> velocities = with_angles(simulation.layout().in(v, "v"), snapshot.state.qdot);
  refuse_velocities_of_pins(velocities, simulation.simulation().model(), snapshot);
  snapshot.state.qdot = std::move(velocities);
  assign(simulation, std::move(snapshot));
}

void bind_snapshot(py::module_& m) {
  py::class_<Snapshot>(m, "Snapshot", "A state that a simulation can return to, with the same bits.")
      .def_property_readonly("time", [](const Snapshot& s) { return s.state.time; })
      .def(py::pickle(py::overload_cast<const Snapshot&>(&tuple_of), &snapshot_in));
}

}  // namespace aspic::python
