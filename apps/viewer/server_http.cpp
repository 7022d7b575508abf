#include "viewer/server_http.h"

#include <fmt/format.h>

#include <boost/beast/websocket.hpp>

#include "base/error.h"

namespace aspic::viewer {
namespace {

namespace beast = boost::beast;
namespace http = beast::http;
using boost::system::error_code;

constexpr uint32_t kLongestHead = 8 << 10;
constexpr uint64_t kLongestBody = uint64_t{64} << 20;  // fits a large picture
constexpr std::chrono::seconds kHeadTime(10), kBodyTime(60);

std::string view(beast::string_view text) { return {text.data(), text.size()}; }

// Content security policy: the page may run its own scripts and connect to this server only. `embed`: see
// ServerOptions.
std::string content_policy(int port, const std::string& embed) {
  return fmt::format(
      "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; img-src data: blob:; font-src data:; "
      "media-src blob:; worker-src blob:; connect-src 'self' ws://127.0.0.1:{0} ws://localhost:{0} data: blob:; "
      "frame-ancestors {1}; "
      "base-uri 'none'; form-action 'none'",
      port, embed.empty() ? "'none'" : embed);
}

// A page hides the token in its address. After a reload it finds the token in the storage of its tab.
constexpr std::string_view kReload = R"(<script>
const token = sessionStorage.getItem("aspic.token");
if (token && !new URL(location.href).searchParams.has("token")) location.replace("/?token=" + encodeURIComponent(token));
</script>)";

std::string text_page(const std::string& text) {
  return fmt::format(
      "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>Aspic</title>"
      "<style>body {{ font: 1.1rem sans-serif; max-width: 36em; margin: 4em auto }}</style><p>{}</p>{}</html>\n",
      text, kReload);
}

}  // namespace

HttpConnection::HttpConnection(Client::Socket socket, HttpService& service)
    : stream_(std::move(socket)), service_(service) {
  place_ = service_.connections.insert(service_.connections.end(), this);
  parser_.header_limit(kLongestHead);
  parser_.body_limit(kLongestBody);
}

HttpConnection::~HttpConnection() { service_.connections.erase(place_); }

void HttpConnection::serve() {
  stream_.expires_after(kHeadTime);
  http::async_read_header(stream_, buffer_, parser_, [self = shared_from_this()](const error_code& error, size_t) {
    if (!error) return self->handle_head();
    if (error == http::error::header_limit) {
      self->answer(self->failure(Status::request_header_fields_too_large, "The head of the request is too long."));
    } else if (error == http::error::body_limit) {
      self->answer(self->failure(Status::payload_too_large, "The body of the request is too long."));
    } else if (error.category() == make_error_code(http::error::bad_method).category() &&
               error != http::error::end_of_stream && error != http::error::partial_message) {
      self->answer(self->failure(Status::bad_request, "This is not an HTTP request."));
    }
  });
}

// Returns the refusal of a request that must not be served, or none.
std::optional<HttpConnection::Response> HttpConnection::refusal(const Client::HttpRequest& request) const {
  const Access& access = service_.access;
  if (!access.is_host(view(request[http::field::host])))
    return failure(Status::forbidden, "This server answers at 127.0.0.1 only: open the address that aspic printed.");
  const std::string origin = view(request[http::field::origin]);
  if (!origin.empty() && !access.is_origin(origin))
    return failure(Status::forbidden, "Another site may not use this server.");
  if (!access.is_token(parse_target(view(request.target())).token))
    return failure(Status::forbidden,
                   "The token in the address is missing or wrong: open the whole address that aspic printed. It "
                   "changes with every start.");
  return std::nullopt;
}

void HttpConnection::handle_head() {
  const Client::HttpRequest& request = parser_.get();
  if (auto refused = refusal(request)) return answer(std::move(*refused));
  has_token_ = true;
  const std::string path = parse_target(view(request.target())).path;
  const bool has_session = service_.options.session != nullptr;
  if (beast::websocket::is_upgrade(request)) {
    if (path != "/session" || !has_session) return answer(failure(Status::not_found, "There is no session here."));
    if (request[http::field::origin].empty())
      return answer(failure(Status::forbidden, "A WebSocket requires the origin of this server's page."));
    if (service_.is_full()) return answer(failure(Status::service_unavailable, "Too many pages are open already."));
    stream_.expires_never();
    return service_.upgrade(stream_.release_socket(), request);
  }
  if (request.method() == http::verb::get) {
    if (path != "/") return answer(failure(Status::not_found, "There is nothing at this address."));
    return answer(response(Status::ok, "text/html; charset=utf-8", service_.options.page));
  }
  if (request.method() == http::verb::post && service_.options.post) {
    stream_.expires_after(kBodyTime);
    http::async_read(stream_, buffer_, parser_, [self = shared_from_this(), path](const error_code& error, size_t) {
      if (!error) return self->handle_body(path);
      if (error == http::error::body_limit)
        self->answer(self->failure(Status::payload_too_large, "The body of the request is too long."));
    });
    return;
  }
  Response refused = failure(Status::method_not_allowed, "This server does not support this method.");
  refused.set(http::field::allow, service_.options.post ? "GET, POST" : "GET");
  answer(std::move(refused));
}

void HttpConnection::handle_body(const std::string& path) {
  try {
    answer(response(Status::ok, "text/plain; charset=utf-8", service_.options.post(path, parser_.get().body())));
  } catch (const InvalidInput& error) {
    answer(response(Status::bad_request, "text/plain; charset=utf-8", error.what()));
  }
}

HttpConnection::Response HttpConnection::failure(Status status, const std::string& text) const {
  return response(status, "text/html; charset=utf-8", text_page(text));
}

HttpConnection::Response HttpConnection::response(Status status, const std::string& type, std::string body) const {
  Response made{status, 11};
  made.set(http::field::content_type, type);
  made.set(http::field::cache_control, "no-store");
  made.set("Content-Security-Policy", content_policy(service_.access.port(), service_.options.embed));
  made.set("Cross-Origin-Opener-Policy", "same-origin");
  made.set("Cross-Origin-Resource-Policy", "same-origin");
  made.set("Referrer-Policy", "no-referrer");
  made.set("X-Content-Type-Options", "nosniff");
  made.keep_alive(false);
  made.body() = std::move(body);
  made.prepare_payload();
  return made;
}

void HttpConnection::answer(Response response) {
  const auto kept = std::make_shared<Response>(std::move(response));
  stream_.expires_after(kBodyTime);
  http::async_write(stream_, *kept, [self = shared_from_this(), kept](const error_code&, size_t) {
    error_code ignored;  // the peer may have disconnected
    self->stream_.socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, ignored);
  });
}

}  // namespace aspic::viewer
