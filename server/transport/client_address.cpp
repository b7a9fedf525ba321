#include "server/transport/client_address.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <utility>

#include "server/support/header_text.h"

namespace vat {

namespace {

using IpAddress = boost::asio::ip::address;

/// Characters of a token (RFC 9110, section 5.6.2).
constexpr std::string_view kTokenCharacters =
    "!#$%&'*+-.^_`|~0123456789ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz";

/// Removes the character from the front of the text. Returns false if the text has another front.
bool take(std::string_view& text, char c) {
  if (text.empty() || text.front() != c) return false;
  text.remove_prefix(1);
  return true;
}

/// Removes a token from the front of the text, and returns it. The token may be empty.
std::string take_token(std::string_view& text) {
  const std::size_t size = std::min(text.find_first_not_of(kTokenCharacters), text.size());
  std::string token(text.substr(0, size));
  text.remove_prefix(size);
  return token;
}

/// Removes a token or a quoted text from the front of the text, and returns it without quotes.
std::optional<std::string> take_value(std::string_view& text) {
  if (!take(text, '"')) return take_token(text);
  std::string value;
  while (!text.empty()) {
    if (take(text, '"')) return value;
    take(text, '\\');
    if (text.empty()) break;
    value += text.front();
    text.remove_prefix(1);
  }
  return std::nullopt;
}

using Nodes = std::vector<std::string>;

/// Returns the parameter `for` of each element of a header Forwarded, empty if it is absent.
/// Returns nothing if the header is malformed.
std::optional<Nodes> forwarded_nodes(std::string_view text) {
  Nodes nodes;
  std::optional<std::string> node;
  for (;;) {
    text = without_spaces(text);
    const std::string name = take_token(text);
    if (name.empty() || !take(text, '=')) return std::nullopt;
    std::optional<std::string> value = take_value(text);
    if (!value) return std::nullopt;
    if (equal_ignoring_case(name, "for")) {
      if (node) return std::nullopt;
      node = std::move(value);
    }
    text = without_spaces(text);
    if (take(text, ';')) continue;
    nodes.push_back(node.value_or(""));
    node.reset();
    if (text.empty()) return nodes;
    if (!take(text, ',')) return std::nullopt;
  }
}

Nodes x_forwarded_for_nodes(std::string_view text) {
  const auto commas = std::count(text.begin(), text.end(), ',');
  Nodes nodes;
  for (auto i = commas; i >= 0; --i) nodes.emplace_back(take_part(text, ','));
  return nodes;
}

/// Returns the address of "192.0.2.1", "192.0.2.1:80", "2001:db8::1", "[2001:db8::1]" or
/// "[2001:db8::1]:80". Returns nothing for other texts, such as "unknown".
std::optional<IpAddress> node_address(const std::string& node) {
  std::string text = node;
  if (text.rfind('[', 0) == 0) {
    const std::size_t end = text.find(']');
    if (end == std::string::npos || (end + 1 < text.size() && text[end + 1] != ':')) return {};
    text = text.substr(1, end - 1);
  } else if (std::count(text.begin(), text.end(), ':') == 1) {
    text.resize(text.find(':'));
  }
  boost::system::error_code error;
  const IpAddress parsed = boost::asio::ip::make_address(text, error);
  if (error) return std::nullopt;
  return without_mapping(parsed);
}

/// Returns the address as 16 bytes. The bytes after an IPv4 address are 0.
std::array<std::uint8_t, 16> bytes_of(const IpAddress& source) {
  if (source.is_v6()) return source.to_v6().to_bytes();
  std::array<std::uint8_t, 16> bytes{};
  const auto short_bytes = source.to_v4().to_bytes();
  std::copy(short_bytes.begin(), short_bytes.end(), bytes.begin());
  return bytes;
}

}  // namespace

TrustedProxies::TrustedProxies(const std::vector<std::string>& networks) {
  for (const std::string& text : networks) networks_.push_back(to_network(text));
}

TrustedProxies::Network TrustedProxies::to_network(const std::string& text) {
  const std::size_t slash = std::min(text.find('/'), text.size());
  boost::system::error_code error;
  Network network{boost::asio::ip::make_address(text.substr(0, slash), error), 0};
  if (error) throw std::invalid_argument("not a network: " + text);
  const unsigned most = network.address.is_v4() ? 32 : 128;
  network.bits = most;
  if (slash == text.size()) return network;
  const char* const end = text.data() + text.size();
  const auto [stop, fault] = std::from_chars(text.data() + slash + 1, end, network.bits);
  if (fault != std::errc() || stop != end || network.bits > most) {
    throw std::invalid_argument("not a network: " + text);
  }
  return network;
}

bool TrustedProxies::contains(const Network& network, const IpAddress& candidate) {
  if (network.address.is_v4() != candidate.is_v4()) return false;
  const auto own = bytes_of(network.address);
  const auto other = bytes_of(candidate);
  for (unsigned bit = 0; bit < network.bits; bit += 8) {
    const unsigned ignored = 8 - std::min(8U, network.bits - bit);
    if ((own[bit / 8] ^ other[bit / 8]) >> ignored != 0) return false;
  }
  return true;
}

bool TrustedProxies::trust(const IpAddress& candidate) const {
  return std::any_of(networks_.begin(), networks_.end(),
                     [&](const Network& network) { return contains(network, candidate); });
}

IpAddress TrustedProxies::client_of(const IpAddress& peer, std::string_view forwarded,
                                    std::string_view x_forwarded_for) const {
  // Returns `peer` if it is not trusted, or if a node after the client is not an address.
  const auto client_among = [&](const Nodes& nodes) {
    IpAddress current = peer;
    for (auto node = nodes.rbegin(); node != nodes.rend() && trust(current); ++node) {
      const std::optional<IpAddress> next = node_address(*node);
      if (!next) return peer;
      current = *next;
    }
    return current;
  };
  const IpAddress by_list =
      x_forwarded_for.empty() ? peer : client_among(x_forwarded_for_nodes(x_forwarded_for));
  if (forwarded.empty()) return by_list;
  const std::optional<Nodes> nodes = forwarded_nodes(forwarded);
  if (!nodes) return peer;
  const IpAddress by_name = client_among(*nodes);
  return x_forwarded_for.empty() || by_list == by_name ? by_name : peer;
}

bool is_network(const std::string& text) {
  try {
    const TrustedProxies checked(std::vector<std::string>{text});
    return true;
  } catch (const std::invalid_argument&) {
    return false;
  }
}

IpAddress without_mapping(const IpAddress& source) {
  if (!source.is_v6() || !source.to_v6().is_v4_mapped()) return source;
  return boost::asio::ip::make_address_v4(boost::asio::ip::v4_mapped, source.to_v6());
}

std::string address_for_limits(const IpAddress& source) {
  if (source.is_v4()) return source.to_string();
  auto bytes = source.to_v6().to_bytes();
  std::fill(bytes.begin() + bytes.size() / 2, bytes.end(), std::uint8_t{0});
  return boost::asio::ip::make_address_v6(bytes).to_string() + "/64";
}

}  // namespace vat
