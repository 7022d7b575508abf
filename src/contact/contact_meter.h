// Measures the cost of contact.
#pragma once
#include <atomic>
#include <cstdint>

#include "base/stopwatch.h"
#include "contact/contact_cost.h"

namespace aspic {

// Adds up the cost, from several threads.
class ContactMeter {
 public:
  enum Kind { search, bound, forces };
  // Adds its lifetime to one kind.
  class Span {
   public:
    Span(ContactMeter& meter, Kind kind) : meter_(meter), kind_(kind) {}
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;
    ~Span() {
      meter_.nanoseconds_[kind_].fetch_add(static_cast<std::int64_t>(1e9 * watch_.lap()), std::memory_order_relaxed);
    }

   private:
    ContactMeter& meter_;
    Kind kind_;
    Stopwatch watch_;
  };
  void add_distances(std::int64_t count) { distances_.fetch_add(count, std::memory_order_relaxed); }
  ContactCost total() const { return {seconds(search), seconds(bound), seconds(forces), distances_}; }

 private:
  double seconds(Kind kind) const { return 1e-9 * static_cast<double>(nanoseconds_[kind]); }

  std::atomic<std::int64_t> nanoseconds_[3] = {};  // libc++ 13 cannot add to atomic floating-point numbers
  std::atomic<std::int64_t> distances_ = 0;
};

}  // namespace aspic
