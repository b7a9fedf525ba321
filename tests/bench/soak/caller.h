#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>

#include "protocol/json/json_reader.h"
#include "server/script/client.h"
#include "tests/bench/soak/tally.h"

namespace vat::bench {

/// A connection of a client that behaves: acknowledges the frames that come, and has each request
/// answered. Throws std::runtime_error where an answer does not come, where it is a fault of the
/// server, and where the connection ends.
class Caller {
 public:
  Caller(std::uint16_t port, Tally& tally);

  /// The whole reply.
  Json call(const std::string& method, const Json& params = Json::object());
  /// The result; throws where it is an error.
  Json result(const std::string& method, const Json& params = Json::object());
  /// Sends a request and does not wait for its reply.
  void send(const std::string& method, const Json& params);
  /// Reads what comes.
  void read_for(std::chrono::milliseconds time);
  /// See script::Client::read().
  void read(bool wanted) { client_->read(wanted); }
  void close() { client_->close(); }
  /// The next message; nothing where none has come by the deadline.
  std::optional<script::Message> next(script::Deadline deadline) { return client_->next(deadline); }
  script::Client& client() { return *client_; }

 private:
  /// Acknowledges it if it is a frame, and gives it if it is text.
  Json take(const script::Message& message);

  Tally& tally_;
  std::unique_ptr<script::Client> client_;
  std::int64_t id_ = 0;
};

/// An open connection to the server.
std::unique_ptr<script::Client> connect(std::uint16_t port);
/// Its answer to GET, as script::fetch_http() tells it. Throws where there is none.
Json fetch(std::uint16_t port, const std::string& path);

}  // namespace vat::bench
