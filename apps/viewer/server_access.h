// Access to the server requires the token and a page of this server. The host name of the request is checked, too, as a
// hostile site may let its own name point to 127.0.0.1 (DNS rebinding).
#pragma once
#include <string>
#include <string_view>

namespace aspic::viewer {

class Access {
 public:
  explicit Access(int port);  // with a new random token of 128 bits

  bool is_host(std::string_view host) const;      // 127.0.0.1 or localhost, with the port
  bool is_origin(std::string_view origin) const;  // a page of this server
  bool is_token(std::string_view text) const;     // in a time that does not tell how much of it is right

  const std::string& token() const { return token_; }
  int port() const { return port_; }

 private:
  int port_;
  std::string token_;
};

struct Target {
  std::string path, token;  // of "/path?token=..."
};
Target parse_target(std::string_view target);

}  // namespace aspic::viewer
