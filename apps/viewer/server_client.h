// The WebSocket connection of a page. Used only by the network's thread.
#pragma once
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <deque>
#include <functional>
#include <memory>
#include <string>

#include "viewer/server_simulation.h"

namespace aspic::viewer {

class Client : public std::enable_shared_from_this<Client> {
 public:
  using Socket = boost::asio::ip::tcp::socket;
  using HttpRequest = boost::beast::http::request<boost::beast::http::string_body>;

  struct Events {
    std::function<void(Client&)> opened;
    std::function<void(Client&, std::string)> received;
    std::function<void(Client&, const std::string& why)> left;  // once, after `opened`; why: empty for an ordinary end
  };

  Client(PageId id, Socket socket, Events events);

  void accept(const HttpRequest& request);
  void send(std::shared_ptr<const Message> message);
  void close(const std::string& why);  // sends the reason and waits briefly
  void cut_off();

  PageId id() const { return id_; }

 private:
  void read();
  void write();
  void end(const std::string& why);
  void cut_off_later();

  PageId id_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> stream_;
  boost::asio::steady_timer patience_;
  boost::beast::flat_buffer buffer_;
  std::deque<std::shared_ptr<const Message>> queue_;  // the first one is being written
  size_t queued_bytes_ = 0;
  bool is_open_ = false, is_closing_ = false;
  std::string why_closed_;
  Events events_;
};

}  // namespace aspic::viewer
