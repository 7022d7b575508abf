#include "viewer/server.h"

#include <fmt/format.h>

#include <algorithm>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <future>
#include <optional>
#include <thread>

#include "base/error.h"
#include "viewer/server_access.h"
#include "viewer/server_http.h"
#include "viewer/server_room.h"
#include "viewer/server_simulation.h"

namespace aspic::viewer {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;
using boost::system::error_code;

constexpr size_t kMaxConnections = 64;  // maximum number of connections without pages
constexpr std::chrono::milliseconds kRetryPeriod(100);
constexpr std::chrono::milliseconds kGoodbye(300);

tcp::acceptor listen(asio::io_context& network, int port) {
  try {
    return {network, tcp::endpoint(asio::ip::address_v4::loopback(), static_cast<unsigned short>(port))};
  } catch (const boost::system::system_error& error) {
    throw InvalidInput(
        fmt::format("port {}: not available ({}); leave --port out to use a free one", port, error.code().message()));
  }
}

}  // namespace

// One thread serves the network, another one runs the simulation.
struct Server::Impl {
  explicit Impl(ServerOptions given)
      : options(std::move(given)),
        service{.access = access,
                .options = options,
                .is_full = [this] { return room.is_full(); },
                .upgrade = [this](tcp::socket socket,
                                  const Client::HttpRequest& request) { room.admit(std::move(socket), request); }},
        acceptor(listen(network, options.port)),
        retry(network),
        access(acceptor.local_endpoint().port()),
        room(network, options.log) {
    if (!options.embed.empty() && !is_site(options.embed))
      throw InvalidInput(
          fmt::format("--embed {}: expected a site without a path, such as http://localhost:8888", options.embed));
    if (options.session) {
      simulation.emplace(*options.session, room);
      room.open(*simulation);
    }
    accept();
    std::promise<void> ended;
    network_ended = ended.get_future();
    thread = std::thread([this, promise = std::move(ended)]() mutable {
      network.run();
      promise.set_value();
    });
  }

  void accept() {
    acceptor.async_accept([this](const error_code& error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (error) return accept_later();
      if (service.connections.size() >= kMaxConnections) cut_off_one();
      error_code ignored;
      socket.set_option(tcp::no_delay(true), ignored);
      std::make_shared<HttpConnection>(std::move(socket), service)->serve();
      accept();
    });
  }

  // Accepting fails immediately while no file descriptor is free.
  void accept_later() {
    retry.expires_after(kRetryPeriod);
    retry.async_wait([this](const error_code& error) {
      if (!error) accept();
    });
  }

  // Closes the oldest connection without a valid token, so that idle connections cannot exclude a browser. If all have
  // a valid token, closes the oldest one.
  void cut_off_one() {
    const auto& all = service.connections;
    const auto stranger = std::find_if(all.begin(), all.end(), [](const auto* one) { return !one->has_token(); });
    (stranger == all.end() ? all.front() : *stranger)->cut_off();
  }

  // Notifies the pages and waits briefly for them.
  void close_network() {
    if (!thread.joinable()) return;
    asio::post(network, [this] {
      error_code ignored;
      acceptor.close(ignored);
      retry.cancel();
      room.close("aspic has ended");
    });
    if (network_ended.wait_for(kGoodbye) != std::future_status::ready) network.stop();
    thread.join();
    room.cut_off();
  }

  ServerOptions options;
  HttpService service;  // must outlive all connections of the network
  asio::io_context network{1};
  tcp::acceptor acceptor;
  asio::steady_timer retry;
  Access access;
  Room room;
  std::optional<SimulationThread> simulation;
  std::thread thread;
  std::future<void> network_ended;
};

Server::Server(ServerOptions options) : impl_(std::make_unique<Impl>(std::move(options))) {}

Server::~Server() { impl_->close_network(); }

int Server::port() const { return impl_->access.port(); }

std::string Server::address() const {
  return fmt::format("http://127.0.0.1:{}/?token={}", port(), impl_->access.token());
}

void Server::announce(const std::string& what) { impl_->room.announce(what); }

void Server::check() const {
  if (impl_->simulation) impl_->simulation->check();
}

bool Server::stop(std::chrono::milliseconds patience) {
  impl_->close_network();
  return !impl_->simulation || impl_->simulation->stop(patience);
}

}  // namespace aspic::viewer
