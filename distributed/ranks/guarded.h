// Errors of a program on several ranks.
#pragma once
#include <exception>
#include <functional>

namespace aspic::distributed {

// Calls `body` within a PetscSession and returns its result. An exception on any rank ends all ranks: it is printed,
// and the program exits with 2 for InvalidInput and with 1 otherwise.
int guarded(const std::function<int()>& body);

// Bad input that has been printed. Thrown on all ranks, so guarded() ends them without MPI_Abort.
struct Refused : std::exception {};

// Calls `body`, which must not communicate, on all ranks. If it throws InvalidInput on some, prints the message of the
// first of these ranks and throws Refused on all ranks. Messages about the initial state come first. Collective.
void all_succeed(const std::function<void()>& body);
// The same, but only one rank calls `body`.
void succeeds_on(int rank, const std::function<void()>& body);

}  // namespace aspic::distributed
