// Counts of communication of this process.
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

// By this program, not by PETSc.
inline Traffic& own_traffic() {
  static Traffic counts;
  return counts;
}

// Within linear solves, by PETSc, too. Their set-up is not counted.
struct LinearTraffic : Traffic {
  double iterations = 0;
};
inline LinearTraffic& linear_traffic() {
  static LinearTraffic counts;
  return counts;
}

}  // namespace aspic::distributed
