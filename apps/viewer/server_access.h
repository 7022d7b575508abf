// Access to the server requires the token and a page of this server. It also requires the host name of this machine,
// because a hostile site may resolve its own name to 127.0.0.1 (DNS rebinding).
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

class Access {
 public:
  explicit Access(int port);  // creates a random token of 128 bits

  bool is_host(std::string_view host) const;      // 127.0.0.1 or localhost, with the port
  bool is_origin(std::string_view origin) const;  // a page of this server
  bool is_token(std::string_view text) const;     // compares in constant time

  const std::string& token() const { return token_; }
  int port() const { return port_; }

 private:
  int port_;
  std::string token_;
};

// Returns whether `text` is scheme://host or scheme://host:port with http or https, as browsers name a site.
bool is_site(std::string_view text);

struct Target {
  std::string path, token;  // the parts of "/path?token=..."
};
Target parse_target(std::string_view target);

}  // namespace aspic::viewer
