// A small thread pool behind two loops whose results do not depend on the number of threads.
#pragma once
#include "base/function_ref.h"

namespace aspic {

int thread_count();                // at first, as many as there are processors for this process
void set_thread_count(int count);  // at least 1; takes effect at the next loop

// Calls body(i) once for every i in [0, count), in any order and on any thread. The bodies must not write to
// the same place. Exceptions must not leave a body. A loop inside a loop runs serially, and so does one that begins
// while another thread of the program is in a loop. Loops allocate nothing once the threads run.
void parallel_for(int count, FunctionRef<void(int)> body);

// Elements per chunk of the loops below: fixed, so that sums round alike for any number of threads. A chunk of vertices
// takes about half a microsecond, some times what it costs to hand it to a thread.
inline constexpr int kChunkSize = 512;

// Calls body(first, last) on consecutive chunks of [0, count).
void parallel_chunks(int count, FunctionRef<void(int first, int last)> body);

// Sum of body(first, last) over the chunks of [0, count), always added in the order of the chunks.
double parallel_sum(int count, FunctionRef<double(int first, int last)> body);

}  // namespace aspic
