#include "server/transport/host_names.h"

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <system_error>

#include "server/support/header_text.h"

namespace vat {

namespace {

constexpr std::size_t kMaxNameBytes = 253;  // of a name in the DNS
constexpr std::string_view kNameCharacters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_.";

/// A host with its port. An absent port is empty.
struct HostParts {
  std::string_view name;
  std::string_view port;
};

bool is_port(std::string_view text) {
  std::uint16_t port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  return error == std::errc() && end == text.data() + text.size() && port > 0;
}

/// Returns nothing if the text is not a host with an optional port.
std::optional<HostParts> split_host(std::string_view text) {
  const bool has_brackets = !text.empty() && text.front() == '[';
  const std::size_t search = has_brackets ? text.find(']') : 0;
  if (search == std::string_view::npos) return std::nullopt;
  const std::size_t colon = text.find(':', search);
  if (colon == std::string_view::npos) return HostParts{text, {}};
  const HostParts parts{text.substr(0, colon), text.substr(colon + 1)};
  if (!is_port(parts.port)) return std::nullopt;
  return parts;
}

/// Returns whether the name is an IPv4 address, or an IPv6 address in brackets.
bool is_numeric(std::string_view name) {
  boost::system::error_code error;
  if (name.size() > 2 && name.front() == '[' && name.back() == ']') {
    boost::asio::ip::make_address_v6(std::string(name.substr(1, name.size() - 2)), error);
  } else {
    boost::asio::ip::make_address_v4(std::string(name), error);
  }
  return !error;
}

}  // namespace

HostKind kind_of_host(std::string_view host, const std::vector<std::string>& public_names) {
  const std::optional<HostParts> parts = split_host(host);
  if (!parts) return HostKind::foreign;
  if (equal_ignoring_case(parts->name, "localhost") || is_numeric(parts->name)) {
    return HostKind::local;
  }
  const auto fits = [&](const std::string& allowed) {
    const std::optional<HostParts> own = split_host(allowed);
    return own && equal_ignoring_case(own->name, parts->name) &&
           (own->port.empty() || own->port == parts->port);
  };
  const bool is_public = std::any_of(public_names.begin(), public_names.end(), fits);
  return is_public ? HostKind::public_name : HostKind::foreign;
}

bool is_host_name(std::string_view text) {
  const std::optional<HostParts> parts = split_host(text);
  return parts && !parts->name.empty() && parts->name.size() <= kMaxNameBytes &&
         parts->name.find_first_not_of(kNameCharacters) == std::string_view::npos;
}

}  // namespace vat
