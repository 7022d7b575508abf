#include "interpreter.h"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

namespace aspic::python {

struct Departure {
  std::mutex mutex;
  std::condition_variable left;
  int computing = 0;                   // releases of the GIL that will take it again
  int calling = 0;                     // calls of Python from these threads
  std::thread::id main = {};           // the thread that ends the program
  std::atomic<bool> is_begun = false;  // `main` is set
  std::atomic<bool> is_over = false;   // the interpreter ends threads that take the GIL
};

namespace {

constexpr int kPatience = 10;  // seconds for computations that do not stop, such as factorizations

// Never destroyed, because threads may outlive static objects. A forked process has none of the threads of its parent,
// and starts with a new one.
std::atomic<Departure*>& current() {
  static std::atomic<Departure*> pointer = new Departure;
  return pointer;
}

// The end of a thread inside of C++ frames would abort the program, so the thread sleeps until the process ends.
void sleep_if_over() {
  while (is_leaving() && current().load()->is_over) std::this_thread::sleep_for(std::chrono::hours(1));
}

// Returns after all computations of other threads have stopped.
void leave() {
  Departure& departure = *current();
  const py::gil_scoped_release free;
  std::unique_lock lock(departure.mutex);
  departure.main = std::this_thread::get_id();
  departure.is_begun = true;
  bool has_left = false;
  for (int i = 0; i < kPatience && !has_left; ++i) {
    has_left = departure.left.wait_for(lock, std::chrono::seconds(1), [&] { return departure.computing == 0; });
    if (departure.computing == departure.calling) break;  // callbacks that wait, perhaps for the thread that waits here
  }
  departure.is_over = !has_left;
}

// For pickle. Protocols 0 and 1 of the inherited method abort the program.
py::tuple reduced(const py::object& self) {
  const py::type type = py::type::of(self);
  if (!py::hasattr(type, "__setstate__"))
    throw py::type_error("cannot pickle '" + type.attr("__name__").cast<std::string>() + "' object");
  return py::make_tuple(py::module_::import("copyreg").attr("__newobj__"), py::make_tuple(type),
                        self.attr("__getstate__")());
}

}  // namespace

ReleasedGil::ReleasedGil() : departure_(*current()) {
  if (is_leaving()) {
    PyErr_SetNone(PyExc_SystemExit);  // ends a thread without a message
    throw py::error_already_set();
  }
  {
    const std::lock_guard lock(departure_.mutex);
    ++departure_.computing;
  }
  thread_ = PyEval_SaveThread();
}

ReleasedGil::~ReleasedGil() {
  sleep_if_over();
  PyEval_RestoreThread(thread_);
  const std::lock_guard lock(departure_.mutex);
  --departure_.computing;
  departure_.left.notify_all();
}

HeldGil::HeldGil() : departure_(*current()) {
  sleep_if_over();
  state_ = PyGILState_Ensure();
  const std::lock_guard lock(departure_.mutex);
  ++departure_.calling;
}

HeldGil::~HeldGil() {
  sleep_if_over();
  {
    const std::lock_guard lock(departure_.mutex);
    --departure_.calling;
  }
  PyGILState_Release(state_);
}

bool is_leaving() {
  const Departure& departure = *current();
  return departure.is_begun && departure.main != std::this_thread::get_id();
}

void watch_for_the_end() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&leave));
  const py::object os = py::module_::import("os");
  os.attr("register_at_fork")(py::arg("after_in_child") = py::cpp_function([] { current() = new Departure; }));
}

void guard_classes(const py::module_& m) {
  for (const auto& [name, value] : py::dict(m.attr("__dict__"))) {
    if (!PyType_Check(value.ptr())) continue;
    auto* type = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr()));
    if (!type) continue;
    type->operator_new = [](size_t) -> void* {  // otherwise pybind11 reads uninitialized memory
      throw py::type_error("__init__() was not called; objects made by __new__() alone cannot be used");
    };
    value.attr("__reduce__") = py::cpp_function(&reduced, py::name("__reduce__"), py::is_method(value));
  }
}

}  // namespace aspic::python
