#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "protocol/client/connection/connection.h"
#include "protocol/json/json_reader.h"
#include "tests/bench/soak/tally.h"

namespace vat::bench {

/// The server closed the connection because the client read too slowly. On a busy machine, this can
/// happen to each client.
class ClosedAsTooSlow : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A connection of a well-behaved client: it acknowledges frames and waits for the reply to each
/// request. Throws ClosedAsTooSlow, or std::runtime_error if a reply does not arrive, reports a
/// server fault, or the connection ends for another reason.
class Caller {
 public:
  Caller(std::uint16_t port, Tally& tally);

  /// Returns the complete reply.
  Json call(const std::string& method, const Json& params = Json::object());
  /// Returns the result. Throws if the reply is an error.
  Json result(const std::string& method, const Json& params = Json::object());
  /// Sends a request without waiting for the reply.
  void send(const std::string& method, const Json& params);
  /// Reads messages for `time`.
  void read_for(std::chrono::milliseconds time);
  /// See client::Connection::read().
  void read(bool wanted) { connection_->read(wanted); }
  void close() { connection_->close(); }
  /// Returns the next message; no value if none arrives by the deadline.
  std::optional<client::Message> next(client::Deadline deadline) {
    return connection_->next(deadline);
  }
  client::Connection& connection() { return *connection_; }

 private:
  /// Acknowledges a frame, or returns a text message.
  Json take(const client::Message& message);

  Tally& tally_;
  std::unique_ptr<client::Connection> connection_;
  std::int64_t id_ = 0;
};

/// Returns an open connection to the server.
std::unique_ptr<client::Connection> connect(std::uint16_t port);
/// Returns the reply to GET in the format of script::fetch_http(). Throws if there is none.
Json fetch(std::uint16_t port, const std::string& path);

}  // namespace vat::bench
