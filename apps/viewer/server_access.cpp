#include "viewer/server_access.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <system_error>

namespace aspic::viewer {
namespace {

std::string random_token() {
  std::array<unsigned char, 16> bytes;
  if (::getentropy(bytes.data(), bytes.size()) != 0)
    throw std::system_error(errno, std::generic_category(), "no random numbers from the system");
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

}  // namespace

Access::Access(int port) : port_(port), token_(random_token()) {}

bool Access::is_host(std::string_view host) const {
  return host == fmt::format("127.0.0.1:{}", port_) || host == fmt::format("localhost:{}", port_);
}

bool Access::is_origin(std::string_view origin) const {
  constexpr std::string_view kScheme = "http://";
  return origin.starts_with(kScheme) && is_host(origin.substr(kScheme.size()));
}

bool Access::is_token(std::string_view text) const {
  if (text.size() != token_.size()) return false;
  unsigned difference = 0;
  for (size_t i = 0; i < token_.size(); ++i)
    difference |= static_cast<unsigned char>(text[i]) ^ static_cast<unsigned char>(token_[i]);
  return difference == 0;
}

bool is_site(std::string_view text) {
  const auto is_word = [](std::string_view word, auto belongs) {
    return !word.empty() && std::all_of(word.begin(), word.end(), belongs);
  };
  const auto is_digit = [](char c) { return c >= '0' && c <= '9'; };
  const auto is_of_host = [&](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || is_digit(c) || c == '.' || c == '-';
  };
  const size_t scheme_end = text.find("://");
  const std::string_view scheme = text.substr(0, scheme_end);
  if (scheme_end == text.npos || (scheme != "http" && scheme != "https")) return false;
  text.remove_prefix(scheme_end + 3);
  const size_t colon = text.find(':');
  return is_word(text.substr(0, colon), is_of_host) &&
         (colon == text.npos || is_word(text.substr(colon + 1), is_digit));
}

Target parse_target(std::string_view target) {
  constexpr std::string_view kKey = "token=";
  const size_t question = target.find('?');
  Target parsed{.path = std::string(target.substr(0, question)), .token = ""};
  std::string_view query = question == target.npos ? "" : target.substr(question + 1);
  while (!query.empty()) {
    const std::string_view part = query.substr(0, query.find('&'));
    if (part.starts_with(kKey)) parsed.token = part.substr(kKey.size());
    query.remove_prefix(std::min(query.size(), part.size() + 1));
  }
  return parsed;
}

}  // namespace aspic::viewer
