// HTTP server of the viewer's page and its session for browsers on this machine. It listens on the loopback interface
// only and requires the token of the printed address. One page steers, the others watch.
#pragma once
#include <chrono>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

namespace aspic::viewer {

class Session;

struct ServerOptions {
  int port = 0;                // 0: any free port
  std::string page;            // HTML
  Session* session = nullptr;  // null: serves only the page, for a recorded run
  std::string embed = {};      // the site that may show the page in a frame, such as http://localhost:8888; "": none

  // Handles the POST requests of the page one by one and returns the response. The server responds to an InvalidInput
  // with its message and status 400. Empty: POST requests are refused.
  std::function<std::string(const std::string& path, std::string_view body)> post = {};

  std::function<void(const std::string& line)> log = {};  // receives the errors of pages; called from any thread
};

class Server {
 public:
  // Starts to listen. Throws InvalidInput if the port is not available or `embed` is not a site.
  explicit Server(ServerOptions options);
  ~Server();  // waits for the end of the current step

  std::string address() const;  // "http://127.0.0.1:PORT/?token=..."
  int port() const;

  void announce(const std::string& what);  // notifies the pages of a long operation; "": of its end

  void check() const;  // rethrows the exception that ended the simulation, if any

  // Closes all connections and interrupts the current step. Returns false if it has not ended within `patience`.
  bool stop(std::chrono::milliseconds patience);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace aspic::viewer
