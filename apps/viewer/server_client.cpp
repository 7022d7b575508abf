#include "viewer/server_client.h"

#include <boost/beast/websocket.hpp>

namespace aspic::viewer {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

constexpr size_t kLongestMessage = size_t{16} << 20;  // received, such as a recorded session
constexpr size_t kQueueBytes = size_t{64} << 20;      // unsent
constexpr size_t kQueueMessages = 20'000;
constexpr std::chrono::seconds kHandshake(10), kIdle(30), kCloseHandshake(2);

// Returns an empty reason for a page that disconnected.
std::string reason(const error_code& error) {
  if (error == websocket::error::message_too_big) return "it sent a message of more than 16 MiB";
  if (error == beast::error::timeout) return "it no longer answers";
  if (error.category() == make_error_code(websocket::error::closed).category() && error != websocket::error::closed)
    return "it broke the WebSocket protocol: " + error.message();
  return "";
}

}  // namespace

Client::Client(PageId id, Socket socket, Events events)
    : id_(id), stream_(std::move(socket)), patience_(stream_.get_executor()), events_(std::move(events)) {
  stream_.set_option(websocket::stream_base::timeout{kHandshake, kIdle, /*keep_alive_pings=*/true});
  stream_.read_message_max(kLongestMessage);
  stream_.auto_fragment(false);
}

void Client::accept(const HttpRequest& request) {
  stream_.async_accept(request, [self = shared_from_this()](const error_code& error) {
    if (error) return;
    self->is_open_ = true;
    self->events_.opened(*self);
    self->read();
  });
}

void Client::read() {
  stream_.async_read(buffer_, [self = shared_from_this()](const error_code& error, size_t) {
    if (error) return self->end(reason(error));
    if (self->stream_.got_binary()) {
      self->buffer_.consume(self->buffer_.size());
      self->close("only text is understood here");
    } else {
      std::string text = beast::buffers_to_string(self->buffer_.data());
      self->buffer_.consume(self->buffer_.size());
      if (!self->is_closing_) self->events_.received(*self, std::move(text));
    }
    self->read();
  });
}

void Client::send(std::shared_ptr<const Message> message) {
  if (!is_open_ || is_closing_) return;
  if (queued_bytes_ > kQueueBytes || queue_.size() > kQueueMessages)
    return close("this page reads its messages too slowly");
  queued_bytes_ += message->bytes.size();
  queue_.push_back(std::move(message));
  if (queue_.size() == 1) write();
}

void Client::write() {
  stream_.binary(queue_.front()->is_binary);
  stream_.async_write(boost::asio::buffer(queue_.front()->bytes),
                      [self = shared_from_this()](const error_code& error, size_t) {
                        if (error) return self->end(reason(error));
                        self->queued_bytes_ -= self->queue_.front()->bytes.size();
                        self->queue_.pop_front();
                        if (!self->queue_.empty() && !self->is_closing_) self->write();
                      });
}

void Client::close(const std::string& why) {
  if (is_closing_ || !is_open_) return;
  is_closing_ = true;
  why_closed_ = why;
  if (queue_.size() > 1) queue_.resize(1);
  constexpr size_t kLongestReason = 123;  // [RFC 6455, section 5.5]
  stream_.async_close({websocket::close_code::policy_error, why.substr(0, kLongestReason)},
                      [self = shared_from_this()](const error_code&) { self->end(""); });
  cut_off_later();
}

// Cuts off a page that does not read the closing message.
void Client::cut_off_later() {
  patience_.expires_after(kCloseHandshake);
  patience_.async_wait([self = shared_from_this()](const error_code& error) {
    if (!error) self->cut_off();
  });
}

void Client::cut_off() { beast::get_lowest_layer(stream_).close(); }

void Client::end(const std::string& why) {
  patience_.cancel();
  cut_off();
  if (!is_open_) return;
  is_open_ = false;
  events_.left(*this, is_closing_ ? why_closed_ : why);
}

}  // namespace aspic::viewer
