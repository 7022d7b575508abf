// Parallel loops on a small thread pool. Their results are independent of the number of threads.
#pragma once
#include "base/function_ref.h"

namespace aspic {

int thread_count();                // initially the number of processors of this process
void set_thread_count(int count);  // at least 1; takes effect at the next loop

// Calls body(i) once for every i in [0, count), in any order and on any thread. The bodies must not write to shared
// memory or throw exceptions. A nested loop runs serially, and so does a loop that begins while another thread of the
// program runs one. Loops do not allocate once the threads run.
void parallel_for(int count, FunctionRef<void(int)> body);

// Elements per chunk of the loops below; fixed, so that rounding is independent of the number of threads. A chunk of
// vertices takes about 0.5 us, several times the cost of passing it to a thread.
inline constexpr int kChunkSize = 512;

// Calls body(first, last) on consecutive chunks of [0, count).
void parallel_chunks(int count, FunctionRef<void(int first, int last)> body);

// Returns the sum of body(first, last) over the chunks of [0, count), added in the order of the chunks.
double parallel_sum(int count, FunctionRef<double(int first, int last)> body);

}  // namespace aspic
