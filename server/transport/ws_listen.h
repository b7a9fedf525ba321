#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>
#include <system_error>

namespace vat {

/// Returns the address of `host`, a numeric IPv4 or IPv6 address, and `port`. Throws as
/// fail_to_listen() does if the host is not numeric.
boost::asio::ip::tcp::endpoint listen_address(const std::string& host, std::uint16_t port);

/// Throws std::runtime_error with host, port and reason.
[[noreturn]] void fail_to_listen(const std::string& host, std::uint16_t port,
                                 const std::string& reason);

/// Listens on the port briefly, without sharing it. Returns the error if that fails.
boost::system::error_code try_to_listen(boost::asio::io_context& io,
                                        const boost::asio::ip::tcp::endpoint& endpoint);

/// Returns the reason why the library could not listen. The library does not report it, so this
/// function repeats the attempt without the library.
std::string listen_failure(boost::asio::io_context& io,
                           const boost::asio::ip::tcp::endpoint& endpoint);

/// Lets several sockets listen on one port (SO_REUSEPORT). Returns the system's error.
std::error_code share_port(boost::asio::ip::tcp::acceptor& acceptor);

}  // namespace vat
