#pragma once

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "protocol/client/exchange/exchange.h"

namespace vat::client::test {

using namespace std::chrono_literals;

inline Json make_description() {
  return {{"session", "s1"},
          {"epoch", 1},
          {"tick", 0},
          {"name", "pool"},
          {"scene", "pool"},
          {"title", "Pool"},
          {"playing", true},
          {"speed", 1},
          {"tick_seconds", 0.02},
          {"vat", nullptr},
          {"materials", Json::array()},
          {"gravity", {0, 0, -9.81}},
          {"bodies", Json::array()}};
}

inline Json make_joined(bool resumed, const std::string& token) {
  return {{"tick", 3},
          {"session", "s1"},
          {"participant", 7},
          {"name", "watcher"},
          {"role", "viewer"},
          {"resume", token},
          {"resumed", resumed},
          {"settings", {{"name", "pool"}, {"default_role", "viewer"}, {"locked", false}}},
          {"participants", Json::array()},
          {"description", make_description()}};
}

inline Json make_info(const std::string& access) {
  return {{"name", "vat"},    {"version", "0.2.0"},        {"protocol", "vat.v1"},
          {"access", access}, {"instruction_set", "avx2"}, {"storage", "memory"},
          {"time", 1.7e9},    {"limits", Json::object()},  {"methods", {"server.info"}}};
}

/// An exchange whose connection the test scripts, without sockets.
class ClientExchange : public testing::Test {
 protected:
  ClientExchange() {
    handlers_.on_state = [this](const StateChange& change) { changes_.push_back(change); };
    handlers_.on_fault = [this](const std::string& fault) { faults_.push_back(fault); };
  }

  /// Returns the next sent message.
  Json sent() {
    for (const std::string& text : calls_.take_output()) sent_.push_back(Json::parse(text));
    if (sent_.empty()) return nullptr;
    Json first = sent_.front();
    sent_.erase(sent_.begin());
    return first;
  }
  void receive(const Json& message) {
    exchange_.receive({Message::Kind::text, message.dump(), 0}, now_);
  }
  void reply(const Json& request, const Json& result) {
    receive({{"jsonrpc", "2.0"}, {"id", request.at("id")}, {"result", result}});
  }
  void refuse(const Json& request, const std::string& kind, int code = 1000) {
    const Json error = {{"code", code}, {"message", "no: " + kind}, {"data", {{"kind", kind}}}};
    receive({{"jsonrpc", "2.0"}, {"id", request.at("id")}, {"error", error}});
  }
  /// Expects a request, and replies.
  void answer(const std::string& method, const Json& result) {
    const Json request = sent();
    ASSERT_EQ(request.value("method", ""), method);
    reply(request, result);
  }
  /// Adds a call of the application. Its outcome is the last element of outcomes_.
  void call(const std::string& method, const Json& params = Json::object()) {
    const auto settle = [this](Outcome<Json> outcome) {
      outcomes_.push_back(outcome ? outcome.value().dump() : outcome.error().kind());
    };
    const auto refused =
        calls_.add({method, params, now_ + 60s, settle}, CallList::Origin::application);
    if (refused) settle(*refused);
  }
  void open(const std::string& access = "open") {
    exchange_.start_connecting();
    exchange_.connected(now_);
    answer("server.info", make_info(access));
  }
  void join_and_subscribe() {
    open();
    call("session.join", {{"name", "watcher"}});
    answer("session.join", make_joined(false, "secret"));
    call("frames.subscribe", {{"max_error", 0.01}});
    answer("frames.subscribe", {{"tick", 4}});
  }
  /// Loses the connection, and connects again after the delay.
  void reconnect() {
    exchange_.lost(0, "end of file", now_);
    ASSERT_EQ(exchange_.state(), ConnectionState::waiting);
    now_ = exchange_.retry_time();
    open();
  }
  void receive_frame(std::uint32_t number, bool is_damaged = false) {
    GridFrame frame;
    frame.header.number = number;
    frame.header.epoch = 1;
    frame.scale.grid = make_frame_grid({0, 0, 0}, {1, 1, 1}, 0);
    std::vector<std::uint8_t> bytes = encode_key_frame(frame);
    if (is_damaged) bytes.back() ^= 1;
    exchange_.receive({Message::Kind::binary, std::string(bytes.begin(), bytes.end()), 0}, now_);
  }

  Options options_;
  Handlers handlers_;
  CallList calls_;
  Exchange exchange_{options_, handlers_, calls_, 1};
  Time now_{1h};
  std::vector<Json> sent_;
  std::vector<StateChange> changes_;
  std::vector<std::string> outcomes_;
  std::vector<std::string> faults_;
};

}  // namespace vat::client::test
