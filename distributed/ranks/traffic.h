// Counts of communication of one rank.
#pragma once

namespace aspic::distributed {

struct Traffic {
  double messages = 0, bytes = 0;  // sent to other ranks
  double reductions = 0;           // collective sums and gathers of all ranks

  Traffic& operator+=(const Traffic& other) {
    messages += other.messages, bytes += other.bytes, reductions += other.reductions;
    return *this;
  }
  friend Traffic operator-(Traffic a, const Traffic& b) {
    return {a.messages - b.messages, a.bytes - b.bytes, a.reductions - b.reductions};
  }
};

// Within linear solves, by PETSc, too. Their set-up is not counted.
struct LinearTraffic : Traffic {
  double iterations = 0;
};

// Counts of a simulation; its Halo holds them, which all solvers have.
struct TrafficCounts {
  Traffic all;           // by this program, not by PETSc
  LinearTraffic linear;  // within linear solves
};

}  // namespace aspic::distributed
