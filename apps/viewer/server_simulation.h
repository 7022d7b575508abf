// The thread that owns the session: carries out what the pages ask for in the order of arrival, and steps when it is
// due. Knows no network; every other thread talks to it through its inbox.
#pragma once
#include <atomic>
#include <condition_variable>
#include <deque>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>

#include "viewer/server_pacing.h"
#include "viewer/session.h"

namespace aspic::viewer {

using PageId = long;                  // of a connected page
inline constexpr PageId kNoPage = 0;  // the server itself

// Who receives what the session says; called on the simulation's thread.
class Audience {
 public:
  virtual ~Audience() = default;
  virtual void greet(PageId page, Messages messages) = 0;
  virtual void tell(PageId page, Messages messages) = 0;
  virtual void tell_all(Messages messages) = 0;
  virtual void show(Messages pictures, long version) = 0;
};

// What a request does not wait for when that takes long: it is interrupted.
enum class Urgency { none, before_questions, before_steps };

enum class Aim { none, mouse, tip };  // what a request moves

struct Request {
  PageId page = kNoPage;
  Role role = Role::watches;
  std::string text;  // empty: the page has just come, and is to be greeted
  Urgency urgency = Urgency::none;
  bool is_question = false;
  Aim aim = Aim::none;  // superseded by one that directly follows with the same
};

class SimulationThread {
 public:
  SimulationThread(Session& session, Audience& audience);
  ~SimulationThread();  // waits for the end of the step under way

  bool add(Request request);  // false: too many wait already
  void want_pictures();       // newer ones than those that were shown last, as soon as there are any

  // Interrupts what is under way if something more urgent waits and it takes long. False: nothing urgent waits.
  bool interrupt_if_slow();

  bool stop(std::chrono::milliseconds patience);  // false: the step under way has not ended
  void check() const;                             // throws what ended the thread

 private:
  using Clock = Pacing::Clock;

  void run();
  void wait();
  bool is_woken() const;
  std::optional<Request> next();
  void carry_out(const Request& request);
  void play();
  void serve_fit();
  void show_pictures();
  template <class Work>
  auto interruptibly(Urgency for_what, Work work);

  Session& session_;
  Audience& audience_;

  // Of the thread alone.
  Pacing pacing_;
  Rate rate_;
  bool was_playing_ = false;
  Clock::time_point next_step_, next_picture_;
  std::optional<long> shown_;
  std::unique_ptr<FitJob> fit_;

  mutable std::mutex mutex_;  // of everything below
  std::condition_variable changed_, ended_;
  std::deque<Request> inbox_;
  size_t inbox_bytes_ = 0;
  bool woken_ = false, stopping_ = false, has_ended_ = false, pictures_wanted_ = false;
  std::optional<Clock::time_point> busy_since_;   // the session works, and may be interrupted
  Urgency gives_way_to_ = Urgency::before_steps;  // then: by what is at least as urgent
  std::exception_ptr failure_;

  std::thread thread_;
};

}  // namespace aspic::viewer
