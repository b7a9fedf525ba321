#pragma once

#include <atomic>
#include <chrono>
#include <map>
#include <stdexcept>
#include <utility>

#include "protocol/client/connection/connection.h"
#include "protocol/json/json_reader.h"
#include "tests/server/fixture/message_record.h"
#include "tests/support/patience.h"

namespace vat::test {

/// Reports that the server has closed the connection.
class Gone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A client that waits up to ten seconds (longer with a sanitizer) for replies. Throws
/// std::runtime_error if one does not arrive or a session differs after recovery. Throws Gone if
/// the connection ends before a reply.
class WaitingClient {
 public:
  explicit WaitingClient(std::uint16_t port) {
    const std::string url = "ws://127.0.0.1:" + std::to_string(port) + "/ws";
    connection_ =
        client::connect_websocket(client::read_websocket_url(url), {}, {}, deadline()).connection;
  }
  bool is_connected() const { return connection_ != nullptr; }
  void close() { connection_->close(); }

  /// Sends a request, and returns its id.
  int send(const std::string& method, const Json& params = Json::object()) {
    const Json request{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}};
    const std::string text = request.dump();
    if (auto* record = next_record()) record->sent(name_, text);
    connection_->send_text(text);
    return id_;
  }
  /// Returns the complete reply.
  Json call(const std::string& method, const Json& params = Json::object()) {
    Json reply = wait(send(method, params));
    if (reply.contains("closed")) throw Gone("closed");
    return reply;
  }
  Json result(const std::string& method, const Json& params = Json::object()) {
    const Json reply = call(method, params);
    if (!reply.contains("result")) throw std::runtime_error(method + ": " + reply.dump());
    return reply.at("result");
  }
  /// Returns the next message with this id or event, or such an event that arrived during another
  /// wait. After the end of the connection it is {"closed": code}.
  Json wait(const Json& id_or_event) {
    if (id_or_event.is_string()) {
      if (auto passed = passed_.extract(id_or_event.get<std::string>()))
        return std::move(passed.mapped());
    }
    for (;;) {
      const auto message = connection_->next(deadline());
      if (!message) throw std::runtime_error("no " + id_or_event.dump());
      if (message->kind == client::Message::Kind::closed) return {{"closed", message->close_code}};
      if (message->kind != client::Message::Kind::text) continue;
      if (auto* record = next_record()) record->received(name_, message->bytes);
      Json json = Json::parse(message->bytes);
      if (json.value("method", "") == "session.diverged") throw std::runtime_error(json.dump());
      if (json.value("id", Json()) == id_or_event) return json;
      if (json.value("method", Json()) == id_or_event) return json;
      if (const std::string event = json.value("method", ""); !event.empty()) {
        passed_[event] = std::move(json);
      }
    }
  }

 private:
  static client::Deadline deadline() {
    return std::chrono::steady_clock::now() + std::chrono::seconds(10 * kSlowdown);
  }
  /// Returns the transcript of the first messages only, because a load repeats the same messages.
  script::Transcript* next_record() {
    return ++messages_ <= kMaxRecorded ? message_record() : nullptr;
  }
  static constexpr int kMaxRecorded = 40;
  int messages_ = 0;
  static std::string next_name() {
    static std::atomic<int> last = 0;
    return std::to_string(++last);
  }
  const std::string name_ = next_name();  ///< name in the transcript
  std::unique_ptr<client::Connection> connection_;
  std::map<std::string, Json> passed_;  ///< the last event of each kind
  int id_ = 0;
};

}  // namespace vat::test
