#pragma once

#include <utility>  // missing in Boost.Asio 1.74 under C++20

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "tests/support/patience.h"

namespace vat::test {

/// The time after which a test fails.
inline constexpr std::chrono::seconds kPatience{10 * kSlowdown};

/// A TCP connection from 127.0.0.1 that sends and receives raw bytes. A call that does not end
/// within kPatience throws std::runtime_error, as does a write to a closed peer.
class RawClient {
 public:
  /// `from` is another address of this machine.
  explicit RawClient(std::uint16_t port, const char* from = "127.0.0.1");

  void write(std::string_view bytes);
  /// Returns at least one byte, or an empty string if the peer has closed or reset the connection.
  std::string read_some();
  std::string read_exactly(std::size_t size);
  /// Returns all bytes until the peer closes or resets the connection.
  std::string read_all();
  /// Ends the stream to the peer. The peer can still send.
  void end_sending();
  /// Ends the connection with a reset, like a killed process with unread bytes.
  void reset();
  void close();

 private:
  template <class Start>
  void await(Start&& start);

  boost::asio::io_context io_;
  boost::asio::ip::tcp::socket socket_;
  bool has_ended_ = false;  // the peer sends no more bytes
};

struct HttpReply {
  int status = 0;
  std::string head;
  std::string body;
  /// Returns the header's value; empty if there is none.
  std::string header(std::string_view name) const;
};

HttpReply parse_reply(const std::string& bytes);
/// Sends one request with the given header lines, each ending in CRLF. The connection is closed
/// after the reply.
HttpReply http(std::uint16_t port, std::string_view method, std::string_view target,
               std::string_view headers = "", std::string_view body = "");
/// Sends a GET request on an open connection, and returns the reply. The reply must have a header
/// Content-Length.
HttpReply http_again(RawClient& client, std::string_view target, std::string_view headers = "");
/// Returns the status of a GET request with this Host header, and further header lines.
int status_for_host(std::uint16_t port, const std::string& host, const std::string& headers = "");

struct Frame {
  int opcode = 0;  ///< 1 text, 2 binary, 8 close, 9 ping, 10 pong
  std::string payload;
};

/// Returns the bytes of a masked client frame.
std::string client_frame(int opcode, std::string_view payload, bool final = true);

/// A WebSocket client written from RFC 6455, independent of the server's library.
class WsClient {
 public:
  /// Opens /ws with vat.v1. Throws if the server refuses.
  explicit WsClient(std::uint16_t port, const char* from = "127.0.0.1");

  void send_text(std::string_view text) { raw_.write(client_frame(1, text)); }
  void send_binary(std::string_view bytes) { raw_.write(client_frame(2, bytes)); }
  /// Returns no value if the connection has ended.
  std::optional<Frame> read_frame();
  /// Returns the next text or binary message. Throws if the connection ends.
  Frame read_message();
  /// Reads up to the close frame and answers it. Returns its code; 0 if the connection ends without
  /// one.
  int read_close();
  RawClient& raw() { return raw_; }

 private:
  RawClient raw_;
  std::string buffer_;
};

/// Returns the header lines of a correct upgrade to vat.v1, without Host.
std::string upgrade_headers(std::string_view subprotocol = "vat.v1",
                            std::string_view version = "13");
/// Returns the reply to an upgrade with these header lines.
HttpReply try_upgrade(std::uint16_t port, std::string_view target, std::string_view headers);

}  // namespace vat::test
