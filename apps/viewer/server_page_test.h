// A page for tests: one WebSocket with a time-out that only a failing test reaches.
#pragma once
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "viewer/server.h"

namespace aspic::viewer::test {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using asio::ip::tcp;
using boost::system::error_code;
using nlohmann::json;

inline constexpr std::chrono::seconds kTooLong(20);

inline tcp::endpoint endpoint_of(const Server& server) {
  return {asio::ip::address_v4::loopback(), static_cast<unsigned short>(server.port())};
}

inline std::string host_of(const Server& server) { return "127.0.0.1:" + std::to_string(server.port()); }

inline std::string token_of(const Server& server) {
  const std::string address = server.address();
  return address.substr(address.find('=') + 1);
}

struct HttpAnswer {
  int status = 0;  // 0: the connection was closed without an answer
  std::string body;
  http::fields fields;
};

struct HttpQuestion {
  http::verb verb = http::verb::get;
  std::string target = "/", host = {}, origin = {}, body = {};
  bool upgrade = false;  // requests a WebSocket
};

// Sends one request. Without `host`, uses the host of the server.
inline HttpAnswer ask(const Server& server, const HttpQuestion& question) {
  asio::io_context network;
  beast::tcp_stream stream(network);
  stream.connect(endpoint_of(server));
  http::request<http::string_body> request{question.verb, question.target, 11};
  request.set(http::field::host, question.host.empty() ? host_of(server) : question.host);
  if (!question.origin.empty()) request.set(http::field::origin, question.origin);
  if (question.upgrade) {
    request.set(http::field::connection, "Upgrade");
    request.set(http::field::upgrade, "websocket");
    request.set(http::field::sec_websocket_version, "13");
    request.set(http::field::sec_websocket_key, "AAAAAAAAAAAAAAAAAAAAAA==");
  }
  request.body() = question.body;
  request.prepare_payload();
  error_code error;
  http::write(stream, request, error);
  beast::flat_buffer buffer;
  http::response<http::string_body> response;
  stream.expires_after(kTooLong);
  bool is_read = false;
  http::async_read(stream, buffer, response, [&](const error_code& failed, size_t) { is_read = !failed; });
  network.run();
  if (!is_read) return {};
  return {static_cast<int>(response.result_int()), response.body(), response.base()};
}

class TestPage {
 public:
  explicit TestPage(const Server& server) : stream_(network_) {
    stream_.next_layer().connect(endpoint_of(server));
    stream_.read_message_max(0);
    stream_.set_option(websocket::stream_base::decorator(
        [&](websocket::request_type& request) { request.set(http::field::origin, "http://" + host_of(server)); }));
    error_code error;
    stream_.handshake(host_of(server), "/session?token=" + token_of(server), error);
    is_refused_ = static_cast<bool>(error);
  }

  bool is_refused() const { return is_refused_; }

  void send(const std::string& text) { write(text, false); }
  void send_binary(const std::string& bytes) { write(bytes, true); }
  void ready() { send("ready"); }

  // Returns the next frame, or none if the connection has ended or nothing arrives within `patience`.
  std::optional<std::string> read(std::chrono::milliseconds patience = kTooLong) {
    if (!is_reading_) {
      is_reading_ = true;
      stream_.async_read(buffer_, [this](const error_code& error, size_t) {
        is_reading_ = false;
        has_ended_ = static_cast<bool>(error);
        has_frame_ = !error;
      });
    }
    network_.restart();
    network_.run_for(patience);
    if (!has_frame_) return std::nullopt;
    has_frame_ = false;
    was_binary_ = stream_.got_binary();
    std::string frame = beast::buffers_to_string(buffer_.data());
    buffer_.consume(buffer_.size());
    return frame;
  }

  // Returns the next text of this kind and skips all others. Returns null if the connection ends first.
  json next(const std::string& kind) {
    while (const auto frame = read()) {
      if (was_binary_) continue;
      json message = json::parse(*frame);
      if (message.at("kind") == kind) return message;
    }
    return nullptr;
  }

  bool next_picture(std::chrono::milliseconds patience = kTooLong) {
    constexpr char kPicture = 2;
    while (const auto frame = read(patience))
      if (was_binary_ && frame->front() == kPicture) return true;
    return false;
  }

  bool has_ended() const { return has_ended_; }
  std::string reason() const { return {stream_.reason().reason.data(), stream_.reason().reason.size()}; }
  void drop() { stream_.next_layer().socket().close(); }

 private:
  void write(const std::string& bytes, bool binary) {
    stream_.binary(binary);
    error_code ignored;  // the program may have closed the connection; reading will fail then
    stream_.write(asio::buffer(bytes), ignored);
  }

  asio::io_context network_;
  websocket::stream<beast::tcp_stream> stream_;
  beast::flat_buffer buffer_;
  bool is_refused_ = false, is_reading_ = false, has_frame_ = false, has_ended_ = false, was_binary_ = false;
};

}  // namespace aspic::viewer::test
