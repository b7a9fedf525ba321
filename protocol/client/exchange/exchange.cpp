#include "protocol/client/exchange/exchange.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "protocol/client/methods/invalid_value.h"
#include "protocol/json/json_reader.h"

namespace vat::client {
namespace {

constexpr JsonLimits kReplyLimits{
    .bytes = std::size_t{64} << 20, .depth = 64, .values = 50'000'000};
/// Texts for the close codes of protocol/PROTOCOL.md.
constexpr std::array<std::pair<std::uint16_t, const char*>, 11> kCloseReasons{{
    {1001, "the server stops"},
    {1002, "the server received an invalid message"},
    {1009, "a message was too large"},
    {1011, "the server has failed"},
    {1013, "the server has too many connections"},
    {4001, "no valid token was sent in time"},
    {4003, "removed from the session"},
    {4008, "this client is too slow"},
    {4009, "this client sends too much"},
    {4010, "another connection has resumed this participant"},
    {4012, "this node of the cluster may not serve the session now"},
}};

std::string describe_close(std::uint16_t code, const std::string& reason) {
  if (code == 0) return reason;
  const auto* known =
      std::ranges::find(kCloseReasons, code, [](const auto& row) { return row.first; });
  std::string words =
      known != kCloseReasons.end() ? known->second : "close code " + std::to_string(code);
  return reason.empty() ? words : words + ": " + reason;
}

/// Returns whether a reconnection would have the same result.
bool is_final(std::uint16_t close_code) {
  return close_code == 4003 || close_code == 4010;
}

bool is_final(const CallError& error) {
  static const std::set<std::string> kFinal{"no_such_session", "not_allowed", "not_authenticated",
                                            "invalid_params", "invalid_reply"};
  return kFinal.contains(error.kind());
}

CallError make_error(const Json& error) {
  Json data = error.value("data", Json());
  if (!data.is_object()) data = Json::object();
  return {data.value("kind", "error"), error.value("message", ""), error.value("code", 0), data};
}

/// Returns the outcome that a reply contains.
Outcome<Json> read_outcome(const Json& message) try {
  if (message.contains("error")) return make_error(message["error"]);
  return message.at("result");
} catch (const Json::exception&) {
  return CallError("invalid_reply", "the reply has neither a result nor an error");
}

}  // namespace

Exchange::Exchange(const Options& options, const Handlers& handlers, CallList& calls,
                   std::uint32_t seed)
    : options_(options), handlers_(handlers), calls_(calls), random_(seed), token_(options.token) {}

Time Exchange::next_check() const {
  const Time silent = is_probing_ ? Time::max() : last_message_ + options_.timeout;
  return std::min(calls_.next_deadline(), silent);
}

void Exchange::start_connecting() {
  change(ConnectionState::connecting);
}

void Exchange::connected(Time now) {
  now_ = connected_at_ = last_message_ = now;
  is_connected_ = true;
  is_probing_ = false;
  receiver_.restart();
  request("server.info", {}, [this](const Json& result) {
    ServerInfo::Result info;
    read_json(result, info);
    if (info.nodes) nodes_ = *info.nodes;
    const bool needs_token = info.access == ServerInfo::Result::Access::token;
    std::vector<std::string> tokens;
    if (needs_token && !resume_.empty()) tokens.push_back(resume_);
    if (!token_.empty()) tokens.push_back(token_);
    enter_with(tokens, needs_token);
  });
}

void Exchange::enter_with(const std::vector<std::string>& tokens, bool needs_token) {
  if (tokens.empty()) {
    if (!needs_token) return rejoin();
    return fail(CallError("not_authenticated", "the server needs a valid token"));
  }
  start_call("access.enter", {{"token", tokens.front()}}, [=, this](const Outcome<Json>& outcome) {
    if (outcome) return rejoin();
    if (outcome.error().kind() != "not_authenticated") return fail(outcome.error());
    enter_with({tokens.begin() + 1, tokens.end()}, needs_token);
  });
}

void Exchange::rejoin() {
  if (moved_join_) {
    Call call = *std::exchange(moved_join_, std::nullopt);
    become_open();
    if (const auto refused = calls_.add(call, CallList::Origin::client)) call.settle(*refused);
    return;
  }
  if (!session_) return become_open();
  Json params = join_params_;
  params["session"] = *session_;
  params["resume"] = resume_;
  start_call("session.join", params, [this](const Outcome<Json>& outcome) {
    if (outcome) return finish_rejoin(outcome.value());
    if (outcome.error().kind() == "moved") return redirect(outcome.error().data().value("url", ""));
    // The participant has left. The next attempt enters with the token of the options.
    if (outcome.error().kind() == "not_authenticated") return lost(0, outcome.error().what(), now_);
    if (!has_session_ended_ || outcome.error().kind() != "no_such_session") {
      return fail(outcome.error());
    }
    forget_session();
    become_open();
  });
}

void Exchange::finish_rejoin(const Json& result) {
  SessionJoin::Result joined;
  read_json(result, joined);  // remember() has checked it
  if (handlers_.on_rejoined) handlers_.on_rejoined(joined);
  if (subscription_.is_null()) return become_open();
  // Also for a resumed participant: a server that was killed can have lost the subscription.
  request("frames.subscribe", subscription_, [this](const Json&) { become_open(); });
}

void Exchange::become_open() {
  was_open_ = true;
  calls_.open();
  change(ConnectionState::open);
}

void Exchange::forget_session() {
  session_.reset();
  resume_.clear();
  subscription_ = {};
}

void Exchange::request(const char* method, Json params,
                       const std::function<void(const Json&)>& proceed) {
  start_call(method, std::move(params), [=, this](const Outcome<Json>& outcome) {
    if (!outcome) return fail(outcome.error());
    try {
      proceed(outcome.value());
    } catch (const InvalidValue& error) {
      fail(CallError("invalid_reply", std::string(method) + ": " + error.what()));
    }
  });
}

void Exchange::start_call(const char* method, Json params,
                          const std::function<void(Outcome<Json>)>& settle) {
  const auto refused = calls_.add({method, std::move(params), now_ + options_.timeout, settle},
                                  CallList::Origin::client);
  if (refused) settle(*refused);
}

void Exchange::fail(const CallError& error) {
  if (!is_connected_) return;  // the loss of the connection is already handled
  const std::string reason =
      error.kind() == "timed_out" ? "the server does not answer" : error.what();
  if (is_final(error)) {
    close(reason);
  } else {
    lost(0, reason, now_);
  }
}

void Exchange::redirect(const std::string& url) {
  constexpr int kMaxAtOnce = 4;  // the nodes may not agree about the owner for some time
  if (!options_.reconnects) return close("the session is at " + url);
  next_url_ = url;
  lost(0, "the session has moved", now_);
  if (!url.empty()) next_url_ = url;
  if (++redirects_ <= kMaxAtOnce) retry_time_ = now_;
}

bool Exchange::follow(const Call& call, const CallError& error) {
  if (call.method != "session.join" || error.kind() != "moved" || !options_.reconnects ||
      state_ != ConnectionState::open) {
    return false;
  }
  moved_join_ = call;
  redirect(error.data().value("url", ""));
  return true;
}

void Exchange::lost(std::uint16_t close_code, const std::string& reason, Time now) {
  if (state_ == ConnectionState::waiting || state_ == ConnectionState::closed) return;
  now_ = now;
  const std::string words = describe_close(close_code, reason);
  if (!was_open_ || !options_.reconnects || is_final(close_code)) return close(words);
  if (is_connected_ && now - connected_at_ > options_.longest_retry) attempts_ = 0;
  is_connected_ = false;
  auto delay =
      std::min(options_.longest_retry, options_.first_retry * (1 << std::min(attempts_, 20)));
  ++attempts_;
  if (nodes_.size() > 1) next_url_ = nodes_[next_node_++ % nodes_.size()];
  const double part = std::uniform_real_distribution<double>(0, 0.25)(random_);
  delay += std::chrono::milliseconds(std::llround(part * static_cast<double>(delay.count())));
  retry_time_ = now + delay;
  state_ = ConnectionState::waiting;
  fail_calls(words);
  change(ConnectionState::waiting, words, delay);
}

void Exchange::close(const std::string& reason) {
  if (state_ == ConnectionState::closed) return;
  is_connected_ = false;
  state_ = ConnectionState::closed;
  fail_calls(reason);
  change(ConnectionState::closed, reason);
}

void Exchange::fail_calls(const std::string& reason) {
  if (state_ == ConnectionState::closed && moved_join_) {
    const Call call = *std::exchange(moved_join_, std::nullopt);
    call.settle(CallError("disconnected", call.method + ": " + reason));
  }
  for (const Call& call : calls_.close()) {
    call.settle(CallError("disconnected", call.method + ": " + reason));
  }
}

void Exchange::change(ConnectionState state, std::string reason,
                      std::chrono::milliseconds retry_in) {
  state_ = state;
  if (handlers_.on_state) handlers_.on_state({state, std::move(reason), retry_in});
}

void Exchange::check(Time now) {
  now_ = now;
  for (const Call& call : calls_.take_expired(now)) {
    call.settle(CallError("timed_out", call.method + ": no reply in time"));
  }
  if (is_connected_ && !is_probing_ && now - last_message_ >= options_.timeout) probe();
}

void Exchange::probe() {
  is_probing_ = true;
  start_call("server.info", {}, [this](const Outcome<Json>& outcome) {
    is_probing_ = false;
    if (!outcome && outcome.error().kind() == "timed_out") fail(outcome.error());
  });
}

void Exchange::receive(const Message& message, Time now) {
  now_ = last_message_ = now;
  if (message.kind == Message::Kind::closed) return lost(message.close_code, message.bytes, now);
  if (message.kind == Message::Kind::text) return receive_text(message.bytes);
  receive_frame(
      {reinterpret_cast<const std::uint8_t*>(message.bytes.data()), message.bytes.size()});
}

void Exchange::receive_text(const std::string& text) {
  const Result<Json> parsed = parse_json(text, kReplyLimits);
  if (!parsed) return report("a message is invalid: " + parsed.errors().front().message);
  const Json& message = parsed.value();
  if (!message.is_object()) return report("a message is not an object");
  const auto method = message.find("method");
  if (method == message.end()) return receive_reply(message);
  if (!method->is_string()) return report("an event has no name");
  try {
    receive_event(*method, message.value("params", Json::object()));
  } catch (const InvalidValue& error) {
    report(method->get<std::string>() + ": " + error.what());
  }
}

void Exchange::receive_reply(const Json& message) {
  const Json id = message.value("id", Json());
  Outcome<Json> outcome = read_outcome(message);
  if (!id.is_number_integer()) {
    return report(outcome ? "a reply has no id" : outcome.error().what());
  }
  const std::optional<Call> call = calls_.take(id.get<std::int64_t>());
  if (!call) return;  // the call has expired
  if (outcome) {
    try {
      remember(*call, outcome.value());
    } catch (const InvalidValue& error) {
      outcome = CallError("invalid_reply", call->method + ": " + error.what());
    }
  }
  if (!outcome && follow(*call, outcome.error())) return;
  call->settle(std::move(outcome));
}

void Exchange::remember(const Call& call, const Json& result) {
  if (call.method == "session.join") {
    SessionJoin::Result joined;
    read_json(result, joined);
    receiver_.restart();
    session_ = joined.session;
    has_session_ended_ = false;
    redirects_ = 0;
    resume_ = joined.resume;
    join_params_ = call.params;
    if (!joined.resumed && state_ == ConnectionState::open) subscription_ = {};
    describe(joined.description);
  } else if (call.method == "session.leave") {
    forget_session();
  } else if (call.method == "frames.subscribe") {
    subscription_ = call.params.is_null() ? Json::object() : call.params;
  } else if (call.method == "frames.unsubscribe") {
    subscription_ = {};
  } else if (call.method == "access.enter" && call.params["token"] != resume_) {
    token_ = call.params["token"].get<std::string>();
  }
}

void Exchange::receive_event(const std::string& name, const Json& params) {
  if (name == "session.description") {
    SessionDescription description;
    read_json(params, description);
    return describe(description);
  }
  // A server that restarts restores the session, and the client joins it again.
  if (name == "session.closed") has_session_ended_ = true;
  deliver_event(name, params, handlers_.events);
  if (name == "session.moved" && session_) redirect(params.value("url", ""));
}

void Exchange::describe(const SessionDescription& description) {
  receiver_.describe(description);
  if (handlers_.events.session_description) handlers_.events.session_description(description);
}

void Exchange::receive_frame(std::span<const std::uint8_t> bytes) {
  const FrameReceiver::Reception reception = receiver_.receive(bytes);
  if (!reception.fault.empty()) report(reception.fault);
  if (reception.is_broken) return lost(0, reception.fault, now_);
  if (reception.frame != nullptr && handlers_.on_frame) handlers_.on_frame(*reception.frame);
  Json params = {{"number", reception.number}};
  if (reception.asks_for_key) params["rejected"] = true;
  calls_.add_notification("frames.ack", params, CallList::Origin::client);
}

void Exchange::report(const std::string& fault) const {
  if (handlers_.on_fault) handlers_.on_fault(fault);
}

}  // namespace vat::client
