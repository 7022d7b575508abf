// One HTTP request: checks access, then serves the page, receives an upload, or hands the WebSocket to the room. Used
// only by the network's thread.
#pragma once
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <functional>
#include <list>
#include <memory>
#include <optional>
#include <string>

#include "viewer/server.h"
#include "viewer/server_access.h"
#include "viewer/server_client.h"

namespace aspic::viewer {

struct HttpService {
  const Access& access;
  const ServerOptions& options;
  std::function<bool()> is_full;  // the maximum number of pages is connected
  std::function<void(Client::Socket, const Client::HttpRequest&)> upgrade;
  std::list<class HttpConnection*> connections;  // current ones, the oldest first
};

class HttpConnection : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Client::Socket socket, HttpService& service);
  ~HttpConnection();

  void serve();
  bool has_token() const { return has_token_; }  // a valid token was received
  void cut_off() { stream_.close(); }

 private:
  using Response = boost::beast::http::response<boost::beast::http::string_body>;
  using Status = boost::beast::http::status;

  void handle_head();
  void handle_body(const std::string& path);
  std::optional<Response> refusal(const Client::HttpRequest& request) const;
  Response failure(Status status, const std::string& text) const;
  Response response(Status status, const std::string& type, std::string body) const;
  void answer(Response response);

  boost::beast::tcp_stream stream_;
  HttpService& service_;
  std::list<HttpConnection*>::iterator place_;  // position in service_.connections
  bool has_token_ = false;
  boost::beast::flat_buffer buffer_;
  boost::beast::http::request_parser<boost::beast::http::string_body> parser_;
};

}  // namespace aspic::viewer
