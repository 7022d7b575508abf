#include "viewer/server_room.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/asio/post.hpp>
#include <nlohmann/json.hpp>

#include "viewer/server_message.h"

namespace aspic::viewer {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kUrgencyPeriod(50);
constexpr size_t kLongestCommand = size_t{1} << 20;  // except recordings and uploaded scenes
constexpr int kComplaints = 5;                       // maximum logged per second

// Returns the slow work that a command interrupts. The commands of kUrgent interrupt a step, others only a question.
Urgency urgency_of(std::string_view command) {
  constexpr std::array<std::string_view, 9> kUrgent = {"pause",  "reset",  "load",    "set",        "rewind",
                                                       "lesson", "replay", "compare", "end_compare"};
  if (command.empty()) return Urgency::none;
  const bool is_urgent = std::find(kUrgent.begin(), kUrgent.end(), command) != kUrgent.end();
  return is_urgent ? Urgency::before_steps : Urgency::before_questions;
}

Aim aim_of(std::string_view command) {
  if (command == "move") return Aim::mouse;
  return command == "press" ? Aim::tool : Aim::none;
}

std::string refusal_text(const std::string& id, const std::string& why) {
  return fmt::format(R"({{"kind":"refused","id":{},"why":{}}})", id, nlohmann::json(why).dump());
}

}  // namespace

void Room::post(std::function<void()> work) { boost::asio::post(network_, std::move(work)); }

void Room::send(const Page& page, std::string text) {
  page.client->send(std::make_shared<const Message>(Message{.is_binary = false, .bytes = std::move(text)}));
}

Room::Page* Room::find(PageId id) {
  const auto found =
      std::find_if(pages_.begin(), pages_.end(), [&](const Page& page) { return page.client->id() == id; });
  return found == pages_.end() ? nullptr : &*found;
}

void Room::admit(Client::Socket socket, const Client::HttpRequest& request) {
  const PageId id = ++last_id_;
  const auto client = std::make_shared<Client>(
      id, std::move(socket),
      Client::Events{.opened = [this](Client& opened) { enter(opened.shared_from_this()); },
                     .received = [this](Client& sender, std::string text) { receive(sender.id(), std::move(text)); },
                     .left = [this](Client& gone, const std::string& why) { leave(gone.id(), why); }});
  client->accept(request);
}

void Room::enter(std::shared_ptr<Client> client) {
  const PageId id = client->id();
  pages_.push_back({.client = std::move(client)});
  if (is_closed_ || pages_.size() > kMaxPages) return pages_.back().client->close("too many pages are open");
  if (steers_ == kNoPage) steers_ = id;
  pages_.back().sent_steers = steers_ == id;
  const Role role = steers_ == id ? Role::steers : Role::watches;
  if (!simulation_->add({.page = id, .role = role})) pages_.back().client->close("the server is busy; try again");
}

void Room::leave(PageId id, const std::string& why) {
  if (!why.empty() && !is_closed_) complain(fmt::format("a page was disconnected: {}", why));
  std::erase_if(pages_, [&](const Page& page) { return page.client->id() == id; });
  if (steers_ == id) steer(pages_.empty() ? kNoPage : pages_.front().client->id());
}

// Releases the body if the previous steering page held it.
void Room::steer(PageId id) {
  if (steers_ == id) return;
  steers_ = id;
  if (is_holding_) simulation_->add({.page = kNoPage, .role = Role::steers, .text = R"({"do":"release"})"});
  is_holding_ = false;
  for (Page& page : pages_) send_role(page);
}

void Room::send_role(Page& page) {
  const bool steers = steers_ == page.client->id();
  if (!page.is_greeted || page.sent_steers == steers) return;
  page.sent_steers = steers;
  send(page, fmt::format(R"({{"kind":"role","steers":{}}})", steers));
}

void Room::receive(PageId id, std::string text) {
  Page* page = find(id);
  if (!page || is_closed_) return;
  if (text == "ready") {
    page->wants_picture = true;
    return offer(*page);
  }
  const MessageHead head = parse_head(text);
  if (!head.is_message) complain("refused a message of a page that does not follow the viewer's protocol");
  if (text.size() > kLongestCommand && head.does != "replay" && head.does != "load")
    return send(*page, refusal_text(head.id, "this message is longer than 1 MiB"));
  if (head.does == "take") return take(*page, head.id);
  if (text.empty()) text = " ";  // refused as an invalid message
  const bool steers = steers_ == id;
  if (steers && (head.does == "grab" || head.does == "release")) is_holding_ = head.does == "grab";
  const Urgency urgency = steers ? urgency_of(head.does) : Urgency::none;
  const bool is_added = simulation_->add({.page = id,
                                          .role = steers ? Role::steers : Role::watches,
                                          .text = std::move(text),
                                          .urgency = urgency,
                                          .is_question = head.does.empty(),
                                          .aim = head.id == "null" ? aim_of(head.does) : Aim::none});
  if (!is_added) return send(*page, refusal_text(head.id, "too many messages wait for the current step"));
  if (urgency != Urgency::none && !is_watching_urgency_) watch_urgency();
}

void Room::take(Page& page, const std::string& id) {
  steer(page.client->id());
  if (id != "null") send(page, fmt::format(R"({{"kind":"reply","id":{},"reply":null}})", id));
}

// Checks periodically whether the current step is slow, as long as an urgent request waits.
void Room::watch_urgency() {
  is_watching_urgency_ = true;
  urgency_.expires_after(kUrgencyPeriod);
  urgency_.async_wait([this](const boost::system::error_code& error) {
    is_watching_urgency_ = false;
    if (!error && !is_closed_ && simulation_->interrupt_if_slow()) watch_urgency();
  });
}

void Room::offer(Page& page) {
  if (!page.is_greeted || !page.wants_picture) return;
  if (page.seen == version_ || pictures_.empty()) return simulation_->want_pictures();
  page.wants_picture = false;
  page.seen = version_;
  for (const auto& picture : pictures_) page.client->send(picture);
}

// Sends all messages in one task, so that no request of the page is handled between them.
void Room::greet(PageId id, Messages messages) {
  post([this, id, sent = std::move(messages)]() mutable {
    send_all(id, std::move(sent));
    Page* page = find(id);
    if (!page) return;
    page->is_greeted = true;
    send_role(*page);
    offer(*page);
  });
}

void Room::reply(PageId id, Messages messages) {
  post([this, id, sent = std::move(messages)]() mutable { send_all(id, std::move(sent)); });
}

void Room::send_all(PageId id, Messages messages) {
  for (Message& message : messages)
    if (Page* page = find(id)) page->client->send(std::make_shared<const Message>(std::move(message)));
}

void Room::broadcast(Messages messages) {
  post([this, sent = std::move(messages)]() mutable {
    for (Message& message : sent) {
      const auto shared = std::make_shared<const Message>(std::move(message));
      for (const Page& page : pages_)
        if (page.is_greeted) page.client->send(shared);
    }
  });
}

void Room::show(Messages pictures, long version) {
  post([this, version, sent = std::move(pictures)]() mutable {
    pictures_.clear();
    for (Message& message : sent) pictures_.push_back(std::make_shared<const Message>(std::move(message)));
    version_ = version;
    for (Page& page : pages_) offer(page);
  });
}

void Room::announce(const std::string& what) {
  broadcast(
      {{.is_binary = false, .bytes = fmt::format(R"({{"kind":"busy","what":{}}})", nlohmann::json(what).dump())}});
}

void Room::close(const std::string& why) {
  is_closed_ = true;
  urgency_.cancel();
  for (const Page& page : pages_) page.client->close(why);
}

void Room::cut_off() {
  for (const Page& page : pages_) page.client->cut_off();
}

void Room::complain(const std::string& line) {
  if (!log_) return;
  const steady_clock::time_point now = steady_clock::now();
  if (now - complaints_since_ > std::chrono::seconds(1)) {
    complaints_since_ = now;
    complaints_ = 0;
  }
  if (++complaints_ <= kComplaints) log_(line);
  if (complaints_ == kComplaints) log_("further messages within this second are omitted");
}

}  // namespace aspic::viewer
