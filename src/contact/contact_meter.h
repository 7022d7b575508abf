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
    ~Span() { meter_.seconds_[kind_].fetch_add(watch_.lap(), std::memory_order_relaxed); }

   private:
    ContactMeter& meter_;
    Kind kind_;
    Stopwatch watch_;
  };
  void add_distances(std::int64_t count) { distances_.fetch_add(count, std::memory_order_relaxed); }
  ContactCost total() const { return {seconds_[search], seconds_[bound], seconds_[forces], distances_}; }

 private:
  std::atomic<double> seconds_[3] = {};
  std::atomic<std::int64_t> distances_ = 0;
};

}  // namespace aspic
