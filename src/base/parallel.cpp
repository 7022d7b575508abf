#include "base/parallel.h"

#include <pthread.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "base/check.h"
#include "base/processors.h"

namespace aspic {
namespace {

// Idle threads spin this long before they sleep, because waking takes as long as a short loop, and a solver starts its
// next loop within microseconds. After the first interval they yield the processor.
constexpr std::chrono::microseconds kSpin{20}, kSpinAlone{2};

void relax_processor() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#else
  std::this_thread::yield();
#endif
}

// Spins for a short while until done(), but not if the awaited thread may need this processor.
template <class Done>
bool spin_until(Done done, bool may_spin) {
  if (done()) return true;
  if (!may_spin) return false;
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  for (;;) {
    for (int i = 0; i < 16; ++i) {
      if (done()) return true;
      relax_processor();
    }
    const auto waited = Clock::now() - start;
    if (waited > kSpin) return false;
    if (waited > kSpinAlone) std::this_thread::yield();
  }
}

// Runs one loop at a time, also on the calling thread. A thread that decrements remaining_ owns an index of the current
// loop, which cannot end before that index is reported in pending_. Hence late threads are harmless, and nothing waits
// for them.
class Pool {
 public:
  ~Pool() { resize(0); }

  int workers() const { return static_cast<int>(threads_.size()); }

  // Starts fewer threads if the system limits processes or memory.
  void resize(int workers) {
    stop();
    may_spin_ = workers < processor_count();
    while (!start(workers)) workers /= 2;
  }

  void run(int count, FunctionRef<void(int)> body) {
    body_ = &body;
    count_ = count;
    pending_ = count;
    remaining_ = count;  // makes the loop visible to the threads
    if (sleeping_ > 0) {
      { std::lock_guard lock(mutex_); }  // threads that saw no work are asleep by now
      wake_.notify_all();
    }
    work();
    const auto done = [this] { return pending_ == 0; };
    if (spin_until(done, may_spin_)) return;
    std::unique_lock lock(mutex_);
    caller_sleeps_ = true;
    done_.wait(lock, done);
    caller_sleeps_ = false;
  }

 private:
  void stop() {
    {
      std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
    quit_ = false;
  }

  // Starts all threads or none, so that a failed attempt releases its memory.
  bool start(int workers) {
    try {
      threads_.reserve(static_cast<size_t>(workers));
      for (int i = 0; i < workers; ++i) threads_.emplace_back([this] { serve(); });
    } catch (const std::exception&) {
      stop();
      return false;
    }
    return true;
  }

  void work() {
    int finished = 0;
    for (int left = remaining_; left > 0;) {
      if (!remaining_.compare_exchange_weak(left, left - 1)) continue;
      (*body_)(count_ - left);
      ++finished;
      left = remaining_;
    }
    if (finished == 0 || (pending_ -= finished) > 0 || !caller_sleeps_) return;
    { std::lock_guard lock(mutex_); }
    done_.notify_one();
  }

  void serve() {
    const auto called = [this] { return remaining_ > 0 || quit_; };
    while (!quit_) {
      work();
      if (spin_until(called, may_spin_)) continue;
      std::unique_lock lock(mutex_);
      ++sleeping_;
      if (!called()) wake_.wait(lock);  // after a late or spurious wake-up, look for the next loop
      --sleeping_;
    }
  }

  std::vector<std::thread> threads_;
  bool may_spin_ = false;
  // Data of each loop that the owner writes before it sets remaining_.
  const FunctionRef<void(int)>* body_ = nullptr;
  int count_ = 0;
  // Unclaimed indices, and unfinished indices.
  std::atomic<int> remaining_ = 0;
  std::atomic<int> pending_ = 0;
  // Written before and read after remaining_ or pending_, so that one of the sides detects the change of the other.
  std::atomic<int> sleeping_ = 0;
  std::atomic<bool> caller_sleeps_ = false, quit_ = false;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
};

std::unique_ptr<Pool>& pool_pointer() {
  static auto instance = std::make_unique<Pool>();
  return instance;
}
Pool& pool() { return *pool_pointer(); }

std::atomic<int>& requested_threads() {
  static std::atomic<int> count = processor_count();
  return count;
}

std::mutex& pool_in_use() {
  static std::mutex instance;
  return instance;
}

thread_local bool inside_loop = false;

int chunk_count(int count) { return (count + kChunkSize - 1) / kChunkSize; }

// A forked process has none of the threads, so it starts with a new pool; that of its parent is abandoned, because
// joining its threads would never end. No loop runs during a fork, except one that forks itself.
void before_fork() {
  if (!inside_loop) pool_in_use().lock();
}
void after_fork() {
  if (!inside_loop) pool_in_use().unlock();
}
void in_forked_process() {
  static_cast<void>(pool_pointer().release());
  pool_pointer() = std::make_unique<Pool>();
  after_fork();
}

Pool& pool_that_survives_forks() {
  static const int registered = pthread_atfork(before_fork, after_fork, in_forked_process);
  static_cast<void>(registered);
  return pool();
}

}  // namespace

int thread_count() { return requested_threads(); }

void set_thread_count(int count) {
  ASPIC_CHECK(count >= 1);
  requested_threads() = std::max(1, count);
}

void parallel_for(int count, FunctionRef<void(int)> body) {
  const int threads = thread_count();
  std::unique_lock lock(pool_in_use(), std::defer_lock);
  if (count <= 1 || threads == 1 || inside_loop || !lock.try_lock()) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  if (pool_that_survives_forks().workers() != threads - 1) {
    pool().resize(threads - 1);
    int requested = threads;  // may have changed in the meantime
    requested_threads().compare_exchange_strong(requested, pool().workers() + 1);
  }
  pool().run(count, [&](int i) {
    inside_loop = true;
    body(i);
    inside_loop = false;
  });
}

namespace {

// An awake thread starts its first chunk after about 0.1 us, but waking one costs the caller a few microseconds.
constexpr int kChunksWorthSharing = 4;

void for_each_chunk(int count, FunctionRef<void(int)> body) {
  const int chunks = chunk_count(count);
  if (chunks >= kChunksWorthSharing) return parallel_for(chunks, body);
  for (int chunk = 0; chunk < chunks; ++chunk) body(chunk);
}

}  // namespace

void parallel_chunks(int count, FunctionRef<void(int, int)> body) {
  for_each_chunk(count, [&](int chunk) { body(chunk * kChunkSize, std::min(count, (chunk + 1) * kChunkSize)); });
}

double parallel_sum(int count, FunctionRef<double(int, int)> body) {
  // Grows once. Moved out during a sum, so that a nested sum on this thread uses its own.
  thread_local std::vector<double> spare;
  std::vector<double> partial = std::move(spare);
  partial.resize(chunk_count(count));
  for_each_chunk(
      count, [&](int chunk) { partial[chunk] = body(chunk * kChunkSize, std::min(count, (chunk + 1) * kChunkSize)); });
  double sum = 0;
  for (const double term : partial) sum += term;
  spare = std::move(partial);
  return sum;
}

}  // namespace aspic
