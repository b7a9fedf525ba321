#include "server/script/player.h"

#include <set>

namespace vat::script {
namespace {

/// Actions and the members that may stand beside them.
const std::map<std::string, std::set<std::string>>& known_actions() {
  static const std::map<std::string, std::set<std::string>> kActions{
      {"connect", {"path", "subprotocol", "refused"}},
      {"fetch", {"response"}},
      {"send", {"wrong"}},
      {"send_text", {"wrong"}},
      {"send_binary", {}},
      {"call", {"params", "result", "error"}},
      {"notify", {"params", "wrong"}},
      {"wait_ticks", {}},
      {"expect", {}},
      {"wait_event", {}},
      {"expect_frame", {}},
      {"wait_frame", {}},
      {"expect_none", {"for", "matching"}},
      {"expect_close", {}},
      {"close", {}},
      {"read", {}},
      {"repeat", {"do"}}};
  return kActions;
}

std::string names_of_actions() {
  std::string names;
  for (const auto& [name, members] : known_actions()) names += (names.empty() ? "" : ", ") + name;
  return names;
}

/// The line's one action; every other member must belong to it.
std::string action_of(const Json& line) {
  std::string action;
  for (const auto& [key, value] : line.items()) {
    if (known_actions().count(key) == 0) continue;
    if (!action.empty()) throw ScriptError("two actions: " + action + " and " + key);
    action = key;
  }
  if (action.empty() && line.size() == 1 && line.contains("comment")) return "comment";
  if (action.empty()) throw ScriptError("no known action, which are " + names_of_actions());
  for (const auto& [key, value] : line.items()) {
    const bool common = key == action || key == "client" || key == "within" || key == "comment";
    if (!common && known_actions().at(action).count(key) == 0) {
      throw ScriptError('"' + key + "\" does not belong to " + action);
    }
  }
  return action;
}

std::chrono::milliseconds seconds(const Json& value) {
  return std::chrono::milliseconds(static_cast<std::int64_t>(value.get<double>() * 1000));
}

std::string from_hex(const std::string& hex) {
  std::string bytes;
  for (std::size_t i = 0; i + 1 < hex.size(); i += 2) {
    bytes += static_cast<char>(std::stoul(hex.substr(i, 2), nullptr, 16));
  }
  return bytes;
}

bool has_id(const Json& pattern) {
  return pattern.contains("id") &&
         (pattern["id"].is_number() ||
          (pattern["id"].is_string() && pattern["id"].get<std::string>().rfind('$', 0) != 0));
}

}  // namespace

void Player::play(const std::vector<Line>& lines) {
  for (const Line& line : lines) {
    try {
      play_line(line.action);
    } catch (const ScriptError& error) {
      throw ScriptError(line.place + ": " + error.what());
    } catch (const Json::exception& error) {
      throw ScriptError(line.place + ": " + error.what());
    } catch (const std::runtime_error& error) {
      throw Failure(line.place + ": " + error.what());
    }
  }
}

void Player::play_line(const Json& line) {
  const std::string action = action_of(line);
  if (action != "comment") run_action(action, line);
}

void Player::run_action(const std::string& action, const Json& line) {
  if (action == "repeat") return repeat(line);
  if (action == "connect") return connect(line);
  if (action == "fetch") return fetch(line);
  if (action == "call") return call(line);
  if (action == "notify") return notify(line);
  if (action == "wait_ticks") return wait_ticks(line);
  if (action == "expect") return expect_reply(line);
  if (action == "wait_event") return wait_for(line, "wait_event", &Peer::events);
  if (action == "wait_frame") return wait_for(line, "wait_frame", &Peer::frames);
  if (action == "expect_frame") return expect_frame(line);
  if (action == "expect_none") return expect_none(line);
  if (action == "expect_close") return expect_close(line);
  if (action == "close") return peer_of(line).socket->close();
  if (action == "read") return peer_of(line).socket->read(line["read"].get<bool>());
  send(line);
}

void Player::repeat(const Json& line) {
  const auto times = line["repeat"].get<int>();
  for (int i = 0; i < times; ++i) {
    captures_["$i"] = i;
    for (const Json& inner : line.at("do")) play_line(inner);
  }
}

void Player::connect(const Json& line) {
  client::ConnectRequest request;
  request.path = line.value("path", request.path);
  request.subprotocol = line.value("subprotocol", request.subprotocol);
  client::Connected connected = connect_(request);
  const unsigned wanted = line.value("refused", 101U);
  if (connected.http_status != wanted) {
    throw Failure("expected HTTP status " + std::to_string(wanted) + ", came " +
                  std::to_string(connected.http_status));
  }
  Peer& peer = peers_[name_of(line["connect"])] = Peer{};
  peer.connection = name_of(line["connect"]) + '#' + std::to_string(++connections_);
  peer.socket = std::move(connected.connection);
}

void Player::fetch(const Json& line) {
  if (!fetch_) throw ScriptError("nothing can be fetched here");
  const auto path = substitute(line["fetch"], captures_).get<std::string>();
  if (!path.starts_with('/')) throw ScriptError("fetch needs a path, which begins with /");
  Json pattern = line.value("response", Json::object());
  if (!pattern.contains("status")) pattern["status"] = 200;
  require(pattern, fetch_(path, deadline_of(line)));
}

void Player::send_text(Peer& peer, const std::string& text, const Json& line) {
  if (transcript_ != nullptr) transcript_->sent(peer.connection, text, line.value("wrong", false));
  peer.socket->send_text(text);
}

void Player::send(const Json& line) {
  Peer& peer = peer_of(line);
  if (line.contains("send")) {
    send_text(peer, substitute(line["send"], captures_).dump(), line);
  } else if (line.contains("send_text")) {
    send_text(peer, substitute(line["send_text"], captures_).get<std::string>(), line);
  } else {
    peer.socket->send_binary(
        from_hex(substitute(line["send_binary"], captures_).get<std::string>()));
  }
}

Json Player::request(Peer& peer, const Json& method, const Json& params, const Json& line) {
  const std::int64_t id = ++last_id_;
  Json request = {{"jsonrpc", "2.0"}, {"id", id}, {"method", method}};
  if (!params.is_null()) request["params"] = substitute(params, captures_);
  send_text(peer, request.dump(), line);
  auto reply = take(peer, &Peer::replies, deadline_of(line),
                    [&](const Json& message) { return message["id"] == id; });
  if (!reply) throw Failure("expected a reply, received none");
  return *std::move(reply);
}

void Player::call(const Json& line) {
  const Json reply = request(peer_of(line), line["call"], line.value("params", Json()), line);
  Json pattern = {{"jsonrpc", "2.0"}};
  const bool fails = line.contains("error");
  pattern[fails ? "error" : "result"] =
      fails ? line["error"] : line.value("result", Json::object());
  pattern[fails ? "result" : "error"] = {{"$absent", true}};
  require(pattern, reply);
}

void Player::wait_ticks(const Json& line) {
  constexpr auto kInterval = std::chrono::milliseconds(10);
  Peer& peer = peer_of(line);
  const client::Deadline deadline = deadline_of(line);
  std::optional<std::uint64_t> wanted;
  for (;;) {
    const Json reply = request(peer, "state.query", {{"bodies", Json::array()}}, line);
    require({{"result", {{"tick", {{"$ge", 0}}}}}}, reply);
    const auto tick = reply["result"]["tick"].get<std::uint64_t>();
    if (!wanted) wanted = tick + line["wait_ticks"].get<std::uint64_t>();
    if (tick >= *wanted) return;
    if (std::chrono::steady_clock::now() > deadline) {
      throw Failure("expected tick " + std::to_string(*wanted) + ", it is " + std::to_string(tick));
    }
    const auto next = std::chrono::steady_clock::now() + kInterval;
    while (receive(peer, next)) {
    }
  }
}

void Player::notify(const Json& line) {
  Json message = {{"jsonrpc", "2.0"}, {"method", line["notify"]}};
  if (line.contains("params")) message["params"] = substitute(line["params"], captures_);
  send_text(peer_of(line), message.dump(), line);
}

void Player::expect_reply(const Json& line) {
  const Json& pattern = line["expect"];
  const auto reply =
      take(peer_of(line), &Peer::replies, deadline_of(line),
           [&](const Json& message) { return !has_id(pattern) || message["id"] == pattern["id"]; });
  if (!reply) throw Failure("expected the reply " + pattern.dump() + ", none came");
  require(pattern, *reply);
}

void Player::wait_for(const Json& line, const char* action, Inbox inbox) {
  const Json& pattern = line[action];
  std::string last = "none came";
  const client::Deadline deadline = deadline_of(line);
  for (;;) {
    const auto message = take(peer_of(line), inbox, deadline, [](const Json&) { return true; });
    if (!message) throw Failure("expected " + pattern.dump() + "; the last received: " + last);
    const auto reason = mismatch(pattern, *message, captures_);
    if (!reason) return;
    last = *reason;
  }
}

void Player::expect_frame(const Json& line) {
  const auto frame =
      take(peer_of(line), &Peer::frames, deadline_of(line), [](const Json&) { return true; });
  if (!frame) throw Failure("expected a frame, received none");
  require(line["expect_frame"], *frame);
}

void Player::expect_none(const Json& line) {
  const std::map<std::string, Inbox> inboxes{
      {"reply", &Peer::replies}, {"event", &Peer::events}, {"frame", &Peer::frames}};
  const client::Deadline deadline = std::chrono::steady_clock::now() + seconds(line.at("for"));
  const Json pattern = line.value("matching", Json("$any"));
  Peer& peer = peer_of(line);
  const Inbox inbox = inboxes.at(line["expect_none"].get<std::string>());
  const auto unwanted = take(peer, inbox, deadline, [&](const Json& message) {
    return !mismatch(pattern, message, captures_).has_value();
  });
  if (unwanted) throw Failure("expected none, came " + unwanted->dump());
  if (peer.closed) throw Failure("expected none, the connection was closed");
}

void Player::expect_close(const Json& line) {
  Peer& peer = peer_of(line);
  const client::Deadline deadline = deadline_of(line);
  while (!peer.closed && receive(peer, deadline)) {
  }
  const std::string wanted =
      "expected the connection to be closed with " + line["expect_close"].dump();
  if (!peer.closed) throw Failure(wanted + "; it is open");
  if (mismatch(line["expect_close"], peer.closed->close_code, captures_)) {
    throw Failure(wanted + ", came " + std::to_string(peer.closed->close_code) + ' ' +
                  peer.closed->bytes);
  }
  peers_.erase(name_of(line.value("client", Json("a"))));
}

std::string Player::name_of(const Json& name) const {
  return substitute(name, captures_).get<std::string>();
}

Player::Peer& Player::peer_of(const Json& line) {
  const std::string name = name_of(line.value("client", Json("a")));
  const auto found = peers_.find(name);
  if (found == peers_.end()) {
    throw ScriptError("no client " + name + "; a line before it has to be {\"connect\": \"" + name +
                      "\"}");
  }
  return found->second;
}

client::Deadline Player::deadline_of(const Json& line) const {
  const auto wait = line.contains("within") ? seconds(line["within"]) : patience_;
  return std::chrono::steady_clock::now() + wait;
}

bool Player::receive(Peer& peer, client::Deadline deadline) {
  if (peer.closed) return false;
  std::optional<client::Message> message = peer.socket->next(deadline);
  if (!message) return false;
  switch (message->kind) {
    case client::Message::Kind::text:
      receive_text(peer, message->bytes);
      break;
    case client::Message::Kind::binary:
      receive_frame(peer, message->bytes);
      break;
    case client::Message::Kind::closed:
      if (transcript_ != nullptr) transcript_->closed(peer.connection, message->close_code);
      peer.closed = std::move(message);
      break;
  }
  return true;
}

void Player::receive_text(Peer& peer, const std::string& text) {
  if (transcript_ != nullptr) transcript_->received(peer.connection, text);
  Json message = Json::parse(text, nullptr, false);
  if (!message.is_object() || message.value("jsonrpc", Json()) != "2.0" ||
      message.contains("id") == message.contains("method")) {
    throw Failure("expected a JSON-RPC reply or event, received " + text);
  }
  const bool is_reply = message.contains("id");
  const Json& content = message.value(is_reply ? "result" : "params", Json::object());
  learn_description(peer, content.is_object() ? content.value("description", content) : content);
  (is_reply ? peer.replies : peer.events).push_back(std::move(message));
}

void Player::learn_description(Peer& peer, const Json& content) {
  if (!content.is_object() || !content.contains("epoch")) return;
  peer.epoch = content["epoch"].get<std::uint64_t>();
  peer.names.clear();
  for (const Json& body : content.value("bodies", Json::array())) {
    peer.names[body.at("body").get<std::uint32_t>()] = body.at("name").get<std::string>();
  }
}

void Player::receive_frame(Peer& peer, const std::string& bytes) {
  Json frame = frame_to_json(bytes, peer.decoder, peer.names);
  if (peer.epoch && frame["epoch"] != *peer.epoch) {
    throw Failure("a frame of epoch " + frame["epoch"].dump() + " after the description of epoch " +
                  std::to_string(*peer.epoch));
  }
  peer.frames.push_back(std::move(frame));
}

template <class Wanted>
std::optional<Json> Player::take(Peer& peer, Inbox inbox, client::Deadline deadline,
                                 Wanted&& wanted) {
  std::deque<Json>& messages = peer.*inbox;
  std::size_t seen = 0;
  do {
    for (; seen < messages.size(); ++seen) {
      if (!wanted(messages[seen])) continue;
      Json found = std::move(messages[seen]);
      messages.erase(messages.begin() + static_cast<std::ptrdiff_t>(seen));
      return found;
    }
  } while (receive(peer, deadline));
  if (peer.closed) {
    throw Failure("the connection was closed with " + std::to_string(peer.closed->close_code) +
                  ' ' + peer.closed->bytes);
  }
  return {};
}

void Player::require(const Json& pattern, const Json& value) {
  if (const auto reason = mismatch(pattern, value, captures_)) throw Failure(*reason);
}

}  // namespace vat::script
