#pragma once

#include <array>
#include <boost/asio.hpp>
#include <memory>
#include <utility>
#include <websocketpp/config/asio_no_tls.hpp>
#include <websocketpp/transport/asio/security/none.hpp>

namespace vat {

/// A plain socket that ends politely: it stops sending, then reads and throws away what the peer
/// still sends until the peer has closed too. Closing with unread bytes would reset the connection,
/// and a peer in the middle of a large message would lose the close frame or error page that tells
/// it why. The library's shutdown timer bounds the wait.
class WsSocket : public websocketpp::transport::asio::basic_socket::connection {
 protected:
  using Done = websocketpp::transport::asio::socket::shutdown_handler;

  void async_shutdown(Done done) {
    boost::system::error_code error;
    get_raw_socket().shutdown(boost::asio::ip::tcp::socket::shutdown_send, error);
    if (error) {
      done(error);
    } else {
      drain(std::move(done));
    }
  }

 private:
  void drain(Done done) {
    get_raw_socket().async_read_some(
        boost::asio::buffer(discarded_), [this, self = get_shared(), done = std::move(done)](
                                             boost::system::error_code error, std::size_t) {
          if (!error) {
            drain(done);
          } else {
            done(error == boost::asio::error::eof ? boost::system::error_code() : error);
          }
        });
  }

  std::array<char, 4096> discarded_;
};

class WsSocketEndpoint : public websocketpp::transport::asio::basic_socket::endpoint {
 public:
  using socket_con_type = WsSocket;
  using socket_con_ptr = std::shared_ptr<WsSocket>;
};

}  // namespace vat
