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

// The calling thread works too; threads take the next index from a shared counter.
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

  void run(int count, const std::function<void(int)>& body) {
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
  void work(int count, const std::function<void(int)>& body) {
    for (int i; (i = next_.fetch_add(1, std::memory_order_relaxed)) < count;) body(i);
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
  const std::function<void(int)>* body_ = nullptr;
  int count_ = 0, busy_ = 0;
  unsigned generation_ = 0;
  bool quit_ = false;
};

Pool& pool() {
  static Pool instance;
  return instance;
}

int& requested_threads() {
  static int count = std::max(1u, std::thread::hardware_concurrency());
  return count;
}

thread_local bool inside_loop = false;  // a loop inside a loop runs serially

}  // namespace

int thread_count() { return requested_threads(); }

void set_thread_count(int count) {
  ASPIC_CHECK(count >= 1);
  requested_threads() = std::max(1, count);
}

void parallel_for(int count, const std::function<void(int)>& body) {
  if (count <= 1 || thread_count() == 1 || inside_loop) {
    for (int i = 0; i < count; ++i) body(i);
    return;
  }
  if (pool().workers() != thread_count() - 1) pool().resize(thread_count() - 1);
  const auto run = [&](int i) {
    inside_loop = true;
    body(i);
    inside_loop = false;
  };
  pool().run(count, std::ref(run));
}

void parallel_chunks(int count, const std::function<void(int, int)>& body) {
  const auto run = [&](int chunk) { body(chunk * kChunkSize, std::min(count, (chunk + 1) * kChunkSize)); };
  parallel_for((count + kChunkSize - 1) / kChunkSize, std::ref(run));  // by reference: nothing is allocated
}

double parallel_sum(int count, const std::function<double(int, int)>& body) {
  const int chunks = (count + kChunkSize - 1) / kChunkSize;
  thread_local std::vector<double> partial;  // grows once; steps allocate nothing
  std::vector<double>& sums = partial;
  sums.resize(chunks);
  const auto run = [&](int chunk) {
    sums[chunk] = body(chunk * kChunkSize, std::min(count, (chunk + 1) * kChunkSize));
  };
  parallel_for(chunks, std::ref(run));
  double sum = 0;
  for (int chunk = 0; chunk < chunks; ++chunk) sum += sums[chunk];
  return sum;
}

}  // namespace aspic
