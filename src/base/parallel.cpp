#include "base/parallel.h"

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <vector>

#include "base/check.h"

namespace aspic {
namespace {

// Runs one loop at a time. The calling thread works too; threads take the next index from a shared counter.
class Pool {
 public:
  ~Pool() { resize(0); }

  int workers() const { return static_cast<int>(threads_.size()); }

  void resize(int workers) {
    {
      std::lock_guard lock(mutex_);
      quit_ = true;
    }
    wake_.notify_all();
    for (std::thread& thread : threads_) thread.join();
    threads_.clear();
    quit_ = false;
    for (int i = 0; i < workers; ++i) threads_.emplace_back([this, seen = generation_] { serve(seen); });
  }

  void run(int count, FunctionRef<void(int)> body) {
    {
      std::lock_guard lock(mutex_);
      body_ = &body;
      count_ = count;
      next_ = 0;
      busy_ = workers();
      ++generation_;
    }
    wake_.notify_all();
    work(count, body);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return busy_ == 0; });
  }

 private:
  void work(int count, FunctionRef<void(int)> body) {
    const auto next = [this] { return next_.fetch_add(1, std::memory_order_relaxed); };
    for (int i = next(); i < count; i = next()) body(i);
  }

  void serve(unsigned seen) {
    std::unique_lock lock(mutex_);
    for (;;) {
      wake_.wait(lock, [&] { return quit_ || generation_ != seen; });
      if (quit_) return;
      seen = generation_;
      const auto* body = body_;
      const int count = count_;
      lock.unlock();
      work(count, *body);
      lock.lock();
      if (--busy_ == 0) done_.notify_one();
    }
  }

  std::vector<std::thread> threads_;
  std::mutex mutex_;
  std::condition_variable wake_, done_;
  std::atomic<int> next_ = 0;
  const FunctionRef<void(int)>* body_ = nullptr;
  int count_ = 0, busy_ = 0;
  unsigned generation_ = 0;
  bool quit_ = false;
};

Pool& pool() {
  static Pool instance;
  return instance;
}

std::atomic<int>& requested_threads() {
  static std::atomic<int> count = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  return count;
}

std::mutex& pool_in_use() {
  static std::mutex instance;
  return instance;
}

thread_local bool inside_loop = false;

int chunk_count(int count) { return (count + kChunkSize - 1) / kChunkSize; }

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
  if (pool().workers() != threads - 1) pool().resize(threads - 1);
  pool().run(count, [&](int i) {
    inside_loop = true;
    body(i);
    inside_loop = false;
  });
}

namespace {

// Waking a thread costs about as much as working through a chunk: a few chunks are faster done alone.
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
  // Grows once. Taken along, so that a sum inside this one, on this thread, has its own.
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
