#pragma once

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>

#include "protocol/json_reader.h"
#include "server/script/client.h"

namespace vat::test {

/// A client that waits, ten seconds at most, for what it is asked for; throws std::runtime_error
/// where that does not come, and where a session has not come back as it was.
class WaitingClient {
 public:
  explicit WaitingClient(std::uint16_t port) {
    const std::string url = "ws://127.0.0.1:" + std::to_string(port) + "/ws";
    client_ = connect_websocket(script::read_websocket_url(url), {}, deadline()).client;
  }
  bool is_connected() const { return client_ != nullptr; }
  void close() { client_->close(); }

  /// The whole reply.
  Json call(const std::string& method, const Json& params = Json::object()) {
    const Json request{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}};
    client_->send_text(request.dump());
    return wait(id_);
  }
  Json result(const std::string& method, const Json& params = Json::object()) {
    const Json reply = call(method, params);
    if (!reply.contains("result")) throw std::runtime_error(method + ": " + reply.dump());
    return reply.at("result");
  }
  /// The next message that has this id or event; {"closed": code} once the connection has ended.
  Json wait(const Json& id_or_event) {
    for (;;) {
      const auto message = client_->next(deadline());
      if (!message) throw std::runtime_error("no " + id_or_event.dump());
      if (message->kind == script::Message::Kind::closed) return {{"closed", message->close_code}};
      if (message->kind != script::Message::Kind::text) continue;
      Json json = Json::parse(message->bytes);
      if (json.value("method", "") == "session.diverged") throw std::runtime_error(json.dump());
      if (json.value("id", Json()) == id_or_event) return json;
      if (json.value("method", Json()) == id_or_event) return json;
    }
  }

 private:
  static script::Deadline deadline() {
    return std::chrono::steady_clock::now() + std::chrono::seconds(10);
  }
  std::unique_ptr<script::Client> client_;
  int id_ = 0;
};

}  // namespace vat::test
