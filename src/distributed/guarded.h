// Errors of a program on several ranks.
#pragma once
#include <functional>

namespace aspic::distributed {

// Calls `body` within a PetscSession and returns its result. An exception on any rank ends all ranks: it is printed,
// and the program exits with 2 for InvalidInput and with 1 otherwise.
int guarded(const std::function<int()>& body);

// Calls `body` on the given rank, and returns on all ranks whether it succeeded. InvalidInput is printed. Collective.
bool succeeds_on(int rank, const std::function<void()>& body);

}  // namespace aspic::distributed
