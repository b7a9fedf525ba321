#include "protocol/client/connection/websocket_url.h"

#include <algorithm>
#include <cctype>
#include <stdexcept>
#include <string_view>

namespace vat::client {
namespace {

constexpr std::string_view kPlain = "ws://";
constexpr std::string_view kSecure = "wss://";

std::invalid_argument fault(const std::string& text, const std::string& reason) {
  return std::invalid_argument("'" + text + "' " + reason +
                               "; expected ws://HOST[:PORT][/PATH] or wss://");
}

/// Where the host ends in "HOST[:PORT]".
std::size_t end_of_host(std::string_view authority) {
  if (!authority.starts_with('[')) return std::min(authority.find(':'), authority.size());
  const std::size_t bracket = authority.find(']');
  return bracket == std::string_view::npos ? 0 : bracket + 1;
}

bool is_port(std::string_view text) {
  const bool digits = std::ranges::all_of(text, [](unsigned char c) { return std::isdigit(c); });
  return digits && !text.empty() && text.size() <= 5 && std::stoul(std::string(text)) <= 65535;
}

}  // namespace

std::string WebSocketUrl::authority() const {
  const bool is_v6 = host.find(':') != std::string::npos;
  return (is_v6 ? '[' + host + ']' : host) + ':' + port;
}

WebSocketUrl read_websocket_url(const std::string& text) {
  WebSocketUrl url;
  url.is_secure = text.starts_with(kSecure);
  if (url.is_secure) url.port = "443";
  if (!url.is_secure && !text.starts_with(kPlain)) throw fault(text, "is not a WebSocket address");
  const std::string rest = text.substr((url.is_secure ? kSecure : kPlain).size());
  const std::size_t slash = std::min(rest.find('/'), rest.size());
  const std::string authority = rest.substr(0, slash);
  const std::size_t end = end_of_host(authority);
  url.host = authority.substr(0, end);
  if (url.host.starts_with('[')) url.host = url.host.substr(1, url.host.size() - 2);
  if (url.host.empty()) throw fault(text, "names no host");
  if (end < authority.size()) {
    url.port = authority.substr(end + 1);
    if (authority[end] != ':' || !is_port(url.port)) throw fault(text, "has no valid port");
  }
  if (rest.size() > slash + 1) url.path = rest.substr(slash);
  return url;
}

}  // namespace vat::client
