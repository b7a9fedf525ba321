#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <cstdint>
#include <string>
#include <system_error>

namespace vat {

/// Returns the address of `host` (numeric IPv4 or IPv6 address) and `port`. If `host` is not
/// numeric, throws like fail_to_listen().
boost::asio::ip::tcp::endpoint listen_address(const std::string& host, std::uint16_t port);

/// Throws std::runtime_error with host, port and reason.
[[noreturn]] void fail_to_listen(const std::string& host, std::uint16_t port,
                                 const std::string& reason);

/// Listens on the port briefly, without sharing the port. Returns an error on failure.
boost::system::error_code try_to_listen(boost::asio::io_context& io,
                                        const boost::asio::ip::tcp::endpoint& endpoint);

/// Returns the reason why the library could not listen. The library does not report the reason, so
/// that this function repeats the attempt without the library.
std::string listen_failure(boost::asio::io_context& io,
                           const boost::asio::ip::tcp::endpoint& endpoint);

/// Allows several sockets to listen on one port (SO_REUSEPORT). Returns the error of the system.
std::error_code share_port(boost::asio::ip::tcp::acceptor& acceptor);

}  // namespace vat
