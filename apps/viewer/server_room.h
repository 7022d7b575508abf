// The connected pages and their roles. Used only by the network's thread. The simulation sends its messages through
// the interface Audience.
#pragma once
#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "viewer/server_client.h"
#include "viewer/server_simulation.h"

namespace aspic::viewer {

using Log = std::function<void(const std::string& line)>;

class Room : public Audience {
 public:
  static constexpr size_t kMaxPages = 16;

  Room(boost::asio::io_context& network, Log log) : network_(network), urgency_(network), log_(std::move(log)) {}

  void open(SimulationThread& simulation) { simulation_ = &simulation; }
  bool is_full() const { return pages_.size() >= kMaxPages; }
  void admit(Client::Socket socket, const Client::HttpRequest& request);
  void close(const std::string& why);  // closes all pages and admits no others
  void cut_off();                      // cuts off the pages that are still connected
  void announce(const std::string& what);

  // Audience: called from the simulation's thread.
  void greet(PageId page, Messages messages) override;
  void reply(PageId page, Messages messages) override;
  void broadcast(Messages messages) override;
  void show(Messages pictures, long version) override;

 private:
  struct Page {
    std::shared_ptr<Client> client;
    bool sent_steers = false;
    bool is_greeted = false;
    bool wants_picture = true;  // true: the first one needs no request
    long seen = -1;             // version of its last picture
  };

  Page* find(PageId id);
  void enter(std::shared_ptr<Client> client);
  void leave(PageId id, const std::string& why);
  void receive(PageId id, std::string text);
  void take(Page& page, const std::string& id);
  void steer(PageId id);
  void send_role(Page& page);
  void offer(Page& page);
  void watch_urgency();
  void complain(const std::string& line);
  static void send(const Page& page, std::string text);
  void send_all(PageId id, Messages messages);
  void post(std::function<void()> work);

  boost::asio::io_context& network_;
  boost::asio::steady_timer urgency_;
  bool is_watching_urgency_ = false, is_closed_ = false;
  SimulationThread* simulation_ = nullptr;
  Log log_;
  std::chrono::steady_clock::time_point complaints_since_;
  int complaints_ = 0;

  std::vector<Page> pages_;  // in order of arrival
  PageId last_id_ = kNoPage, steers_ = kNoPage;
  bool is_holding_ = false;                               // the steering page has grabbed the body
  std::vector<std::shared_ptr<const Message>> pictures_;  // the last ones shown
  long version_ = -1;
};

}  // namespace aspic::viewer
