// Serves the viewer's page, and a session to it, to browsers on this machine: loopback only, nothing without the token
// of the printed address. Pages come and go; one steers, the others watch.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace aspic::viewer {

class Session;

struct ServerOptions {
  int port = 0;                // 0: any free one
  std::string page;            // HTML
  Session* session = nullptr;  // none: the page alone is served, as of a recorded run

  // Called with what the page sends by POST, one after the other; what it returns is the answer. An InvalidInput is
  // answered in its words, status 400. Empty: nothing can be sent.
  std::function<std::string(const std::string& path, std::string_view body)> post = {};

  std::function<void(const std::string& line)> log = {};  // what went wrong with a page; called from any thread
};

class Server {
 public:
  // Listens from now on. Throws InvalidInput: the port cannot be had.
  explicit Server(ServerOptions options);
  ~Server();  // waits for the session's step under way

  std::string address() const;  // "http://127.0.0.1:PORT/?token=..."
  int port() const;

  void announce(const std::string& what);  // notifies the pages of a long operation; "": it is done

  void check() const;  // throws what has ended the simulation, if anything has

  // Closes every connection and interrupts the step under way; false: that has not ended within `patience`.
  bool stop(std::chrono::milliseconds patience);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
