#include "tests/bench/soak/caller.h"

#include <optional>
#include <stdexcept>

#include "server/script/http_fetch.h"
#include "tests/bench/fanout/frame_facts.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;

/// A server with a sanitizer on a busy machine takes seconds.
constexpr std::chrono::seconds kCallerPatience{60};
constexpr int kInternalError = -32603;
constexpr std::uint16_t kTooSlow = 4008;

client::WebSocketUrl url_of(std::uint16_t port) {
  return client::read_websocket_url("ws://127.0.0.1:" + std::to_string(port) + "/ws");
}

}  // namespace

std::unique_ptr<client::Connection> connect(std::uint16_t port) {
  auto connected =
      client::connect_websocket(url_of(port), {}, {}, steady_clock::now() + kCallerPatience);
  if (connected.connection == nullptr) {
    throw std::runtime_error("not let in: " + std::to_string(connected.http_status));
  }
  return std::move(connected.connection);
}

Json fetch(std::uint16_t port, const std::string& path) {
  return script::fetch_http(url_of(port), {}, path, steady_clock::now() + kCallerPatience);
}

Caller::Caller(std::uint16_t port, Tally& tally) : tally_(tally), connection_(connect(port)) {}

Json Caller::call(const std::string& method, const Json& params) {
  const auto begin = steady_clock::now();
  send(method, params);
  for (;;) {
    const auto message = connection_->next(begin + kCallerPatience);
    if (!message) throw std::runtime_error(method + " was not answered");
    Json json = take(*message);
    if (!json.is_object() || json.value("id", Json()) != Json(id_)) continue;
    tally_.add_wait(std::chrono::duration<double>(steady_clock::now() - begin).count());
    ++tally_.requests;
    if (json.contains("error")) {
      ++tally_.refused;
      if (json["error"]["code"] == kInternalError) throw std::runtime_error(method + json.dump());
    }
    return json;
  }
}

Json Caller::result(const std::string& method, const Json& params) {
  const Json reply = call(method, params);
  if (!reply.contains("result")) throw std::runtime_error(method + ": " + reply.dump());
  return reply.at("result");
}

void Caller::send(const std::string& method, const Json& params) {
  const Json request{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}};
  connection_->send_text(request.dump());
}

void Caller::read_for(std::chrono::milliseconds time) {
  const auto end = steady_clock::now() + time;
  while (const auto message = connection_->next(end)) take(*message);
}

Json Caller::take(const client::Message& message) {
  using Kind = client::Message::Kind;
  if (message.kind == Kind::closed) {
    const std::string reason =
        "closed with " + std::to_string(message.close_code) + " " + message.bytes;
    if (message.close_code == kTooSlow) throw ClosedAsTooSlow(reason);
    throw std::runtime_error(reason);
  }
  if (message.kind == Kind::text) return Json::parse(message.bytes);
  ++tally_.frames;
  connection_->send_text(acknowledgement(frame_facts(message.bytes)));
  return {};
}

}  // namespace vat::bench
