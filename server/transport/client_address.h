#pragma once

#include <boost/asio/ip/address.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace vat {

/// Networks of trusted proxies. A request from a trusted proxy names the client in the header
/// Forwarded (RFC 7239) or X-Forwarded-For.
class TrustedProxies {
 public:
  /// Throws std::invalid_argument if a text is not a network, see is_network().
  explicit TrustedProxies(const std::vector<std::string>& networks);

  bool trust(const boost::asio::ip::address& address) const;
  /// Returns the address of the client. `peer` is the address of the socket. Each proxy appends the
  /// address of its peer to the headers, so that the client is the last address that is not
  /// trusted. Returns `peer` if `peer` is not trusted, the headers are malformed, or both headers
  /// are present and name different clients.
  boost::asio::ip::address client_of(const boost::asio::ip::address& peer,
                                     std::string_view forwarded,
                                     std::string_view x_forwarded_for) const;

 private:
  struct Network {
    boost::asio::ip::address address;
    unsigned bits;  // number of the leading bits that are compared
  };
  static Network to_network(const std::string& text);
  static bool contains(const Network& network, const boost::asio::ip::address& address);

  std::vector<Network> networks_;
};

/// Returns whether the text is a numeric address, or a network such as "10.0.0.0/8" or "fd00::/8".
bool is_network(const std::string& text);

/// Returns the IPv4 address of an IPv4-mapped IPv6 address, and any other address unchanged.
boost::asio::ip::address without_mapping(const boost::asio::ip::address& address);

/// Returns the text of Connection::address().
std::string address_for_limits(const boost::asio::ip::address& address);

}  // namespace vat
