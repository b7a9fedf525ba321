#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>

#include "protocol/json/json_reader.h"
#include "server/script/client.h"
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
  /// See script::Client::read().
  void read(bool wanted) { client_->read(wanted); }
  void close() { client_->close(); }
  /// Returns the next message; no value if none arrives by the deadline.
  std::optional<script::Message> next(script::Deadline deadline) { return client_->next(deadline); }
  script::Client& client() { return *client_; }

 private:
  /// Acknowledges a frame, or returns a text message.
  Json take(const script::Message& message);

  Tally& tally_;
  std::unique_ptr<script::Client> client_;
  std::int64_t id_ = 0;
};

/// Returns an open connection to the server.
std::unique_ptr<script::Client> connect(std::uint16_t port);
/// Returns the reply to GET in the format of script::fetch_http(). Throws if there is none.
Json fetch(std::uint16_t port, const std::string& path);

}  // namespace vat::bench
