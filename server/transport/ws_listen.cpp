#include "server/transport/ws_listen.h"

#include <sys/socket.h>

#include <boost/asio/socket_base.hpp>
#include <cerrno>
#include <stdexcept>

namespace vat {

using boost::asio::ip::tcp;

tcp::endpoint listen_address(const std::string& host, std::uint16_t port) {
  boost::system::error_code error;
  const auto address = boost::asio::ip::make_address(host, error);
  if (error) fail_to_listen(host, port, "the host must be a numeric address");
  return {address, port};
}

std::error_code share_port(tcp::acceptor& acceptor) {
  const int on = 1;
  if (setsockopt(acceptor.native_handle(), SOL_SOCKET, SO_REUSEPORT, &on, sizeof on) == 0)
    return {};
  return {errno, std::system_category()};
}

void fail_to_listen(const std::string& host, std::uint16_t port, const std::string& reason) {
  const bool is_v6 = host.find(':') != std::string::npos;
  throw std::runtime_error("cannot listen on " + (is_v6 ? "[" + host + "]" : host) + ":" +
                           std::to_string(port) + ": " + reason);
}

boost::system::error_code try_to_listen(boost::asio::io_context& io,
                                        const tcp::endpoint& endpoint) {
  boost::system::error_code error;
  tcp::acceptor acceptor(io);
  acceptor.open(endpoint.protocol(), error);
  if (!error) acceptor.set_option(boost::asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(endpoint, error);
  if (!error) acceptor.listen(boost::asio::socket_base::max_listen_connections, error);
  return error;
}

std::string listen_failure(boost::asio::io_context& io, const tcp::endpoint& endpoint) {
  const auto error = try_to_listen(io, endpoint);
  return error ? error.message() : "the port was in use a moment ago";
}

}  // namespace vat
