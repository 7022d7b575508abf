// Objects that one thread at a time may use, because the library keeps scratch data in them.
#pragma once
#include <stdexcept>
#include <string>
#include <thread>

namespace aspic::python {

// Who uses an object; guarded by the GIL.
struct Occupancy {
  std::thread::id thread{};
  int depth = 0;
  const char* advice = "give each thread its own";

  bool is_elsewhere() const { return depth > 0 && thread != std::this_thread::get_id(); }
};

// Uses an object as long as this lives. Construct and destroy it with the GIL; in between the GIL may be released.
class Use {
 public:
  // Throws std::runtime_error if another thread uses the object. The same thread may, as in a callback.
  Use(Occupancy& occupancy, const char* what) : occupancy_(occupancy) {
    if (occupancy.is_elsewhere())
      throw std::runtime_error(std::string("another thread uses this ") + what + "; " + occupancy.advice);
    occupancy_.thread = std::this_thread::get_id();
    ++occupancy_.depth;
  }
  ~Use() { --occupancy_.depth; }
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  Occupancy& occupancy_;
};

// Throws std::runtime_error if this thread computes with the object, because `call` would change the computation.
inline void require_idle(const Occupancy& occupancy, const char* call) {
  if (occupancy.depth > 0 && !occupancy.is_elsewhere())
    throw std::runtime_error(std::string(call) + "() was called inside a computation of the same object");
}

}  // namespace aspic::python
