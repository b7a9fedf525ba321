#include "server/relay/relayed_client.h"

#include <algorithm>
#include <mutex>
#include <utility>

#include "core/support/check.h"
#include "server/access/role.h"
#include "server/support/log.h"

namespace vat {
namespace {

// The owner answers requests of the client itself with other ids or in other states.
constexpr const char* kEnterId = "vat.enter";
constexpr const char* kJoinId = "vat.join";
constexpr const char* kLeaveId = "vat.leave";
constexpr std::string_view kEventStart = R"({"jsonrpc":"2.0","method":")";

/// Returns the name of the event, or nothing if the text is a reply.
std::string_view event_of(std::string_view text) {
  if (!text.starts_with(kEventStart)) return {};
  text.remove_prefix(kEventStart.size());
  return text.substr(0, text.find('"'));
}

std::string write_request(const char* id, const char* method, const Json& params) {
  return Json{{"jsonrpc", "2.0"}, {"id", id}, {"method", method}, {"params", params}}.dump();
}

/// Returns the error of a reply of another node.
RpcError read_error(const Json& error) {
  Json data = error.at("data");
  const auto name = data.at("kind").get<std::string>();
  data.erase("kind");
  data.erase("hint");
  for (const ErrorRow& row : error_rows()) {
    if (row.name == name) return {row.kind, error.at("message"), std::move(data)};
  }
  return internal_error();
}

Role read_role(const Json& name) {
  for (const Role role : {Role::viewer, Role::controller, Role::owner, Role::admin}) {
    if (name == to_string(role)) return role;
  }
  return Role::none;
}

}  // namespace

RelayedClient::RelayedClient(Place place, std::unique_ptr<RelayLine> line,
                             std::shared_ptr<ClientOutbox> outbox, Links links, const Clock& clock)
    : place_(std::move(place)),
      line_(std::move(line)),
      outbox_(std::move(outbox)),
      links_(std::move(links)),
      clock_(clock),
      membership_(outbox_->join()) {}

RelayedClient::~RelayedClient() {
  abandon();
}

void RelayedClient::join(PendingReply reply, const Grant& access, const std::string& token,
                         const Json& params) {
  {
    const std::lock_guard lock(mutex_);
    joining_ = std::move(reply);
    is_entering_ = !token.empty();
  }
  send(RelayKind::open,
       {{"subject", place_.subject},
        {"address", outbox_->address()},
        {"access",
         {{"role", static_cast<int>(access.role)},
          {"session", access.session},
          {"is_invitation", access.is_invitation}}}},
       {});
  if (!token.empty()) {
    send(RelayKind::text, Json::object(),
         write_request(kEnterId, "access.enter", {{"token", token}}));
  }
  send(RelayKind::text, Json::object(), write_request(kJoinId, "session.join", params));
}

void RelayedClient::forward(std::string_view message, bool wants_reply) {
  {
    const std::lock_guard lock(mutex_);
    replies_due_ += wants_reply ? 1 : 0;
  }
  send(RelayKind::text, Json::object(), std::string(message));
}

void RelayedClient::send(RelayKind kind, Json fields, std::string body) {
  if (!line_->send(kind, std::move(fields), std::move(body))) fail();
}

void RelayedClient::leave(PendingReply reply) {
  {
    const std::lock_guard lock(mutex_);
    leaving_ = std::move(reply);
    keeper_ = shared_from_this();
  }
  end();
  send(RelayKind::text, Json::object(), write_request(kLeaveId, "session.leave", Json::object()));
}

void RelayedClient::when_joined(std::function<void()> task) {
  VAT_CHECK(mutex_.is_held());
  if (state_ == State::joining) return when_joined_.push_back(std::move(task));
  task();
}

void RelayedClient::subscribe(PendingReply reply, const Subscription& wanted) {
  const std::lock_guard lock(mutex_);
  when_joined([this, wanted, waiting = std::make_shared<PendingReply>(std::move(reply))] {
    if (feed_ == nullptr || feed_->has_ended()) feed_ = links_.feed();
    const std::uint64_t number = outbox_->subscribe(membership_, feed_->frames(), clock_.now());
    if (number == 0) return waiting->answer(not_joined());
    feed_->add(outbox_, number, wanted);
    waiting->answer(Json{{"tick", tick_locked()}});
  });
}

void RelayedClient::unsubscribe(PendingReply reply) {
  const std::lock_guard lock(mutex_);
  when_joined([this, waiting = std::make_shared<PendingReply>(std::move(reply))] {
    outbox_->unsubscribe();
    if (feed_ != nullptr) std::exchange(feed_, nullptr)->remove(outbox_->id());
    waiting->answer(Json{{"tick", tick_locked()}});
  });
}

std::uint64_t RelayedClient::tick_locked() const {
  VAT_CHECK(mutex_.is_held());
  return std::max(joined_tick_, feed_ == nullptr ? 0 : feed_->tick());
}

bool RelayedClient::has_left() const {
  const std::lock_guard lock(mutex_);
  return state_ == State::left || state_ == State::closed;
}

std::uint64_t RelayedClient::tick() const {
  const std::lock_guard lock(mutex_);
  return tick_locked();
}

void RelayedClient::receive(RelayMessage message) {
  RelayInput::Taken taken{};
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::left && !leaving_) return;
    taken = received_.take(message);
  }
  if (taken == RelayInput::Taken::part) return;
  if (taken == RelayInput::Taken::lost) {
    log_warning("relay: a message of the node {} was lost", place_.owner);
    return fail();
  }
  if (message.kind == RelayKind::text) return receive_text(message.body);
  if (message.kind != RelayKind::end || !end()) return;
  outbox_->close(message.fields.value("code", std::uint16_t{1011}),
                 message.fields.value("reason", std::string()));
}

void RelayedClient::receive_text(const std::string& text) {
  if (const std::string_view event = event_of(text); !event.empty()) {
    return receive_event(event, text);
  }
  if (receive_reply(text)) return;
  outbox_->send(text);
  count_reply();
}

void RelayedClient::receive_event(std::string_view event, const std::string& text) {
  if (event.starts_with("server.")) return;  // of the other node
  if (event == "session.moved") {
    links_.note_move();
    return fail();
  }
  outbox_->send_event(membership_, std::make_shared<const std::string>(text));
  if (event == "session.description") {
    // Not before the event, so that no frame of the epoch is sent earlier.
    outbox_->start_epoch(membership_, Json::parse(text).at("params").at("epoch"));
  }
  if (event == "session.closed") close();
}

bool RelayedClient::receive_reply(const std::string& text) {
  {
    const std::lock_guard lock(mutex_);
    if (!joining_ && !leaving_ && !is_entering_) return false;
  }
  Json message = Json::parse(text);
  const Json& id = message.at("id");
  if (id == kEnterId) {  // may follow the reply to the join
    {
      const std::lock_guard lock(mutex_);
      is_entering_ = false;
      if (!joining_) return true;
    }
    if (message.contains("error")) finish_join(message);
    return true;
  }
  if (id == kJoinId) {
    finish_join(message);
    return true;
  }
  if (id != kLeaveId) return false;
  const auto keep = shared_from_this();
  const std::lock_guard lock(mutex_);
  if (leaving_) leaving_->answer(message.value("result", Json::object()));
  leaving_.reset();
  keeper_.reset();
  line_->send(RelayKind::end);
  return true;
}

void RelayedClient::finish_join(const Json& message) {
  if (const auto error = message.find("error"); error != message.end()) {
    RpcError answer = read_error(*error);
    if (answer.kind == ErrorKind::moved) {
      links_.note_move();
      answer = moved_to(place_.session, place_.own_url);
    }
    std::optional<PendingReply> reply;
    {
      const std::lock_guard lock(mutex_);
      reply.swap(joining_);
    }
    if (!end()) return;
    line_->send(RelayKind::end);
    if (reply) reply->answer(std::move(answer));
    return;
  }
  const Json& result = message.at("result");
  const std::lock_guard lock(mutex_);
  if (state_ != State::joining || !joining_) return;
  state_ = State::joined;
  joined_tick_ = result.at("tick");
  outbox_->set_role(membership_, read_role(result.at("role")));
  outbox_->start_epoch(membership_, result.at("description").at("epoch"));
  joining_->answer(result);
  joining_.reset();
  for (const auto& task : std::exchange(when_joined_, {})) task();
}

bool RelayedClient::end() {
  const std::lock_guard lock(mutex_);
  if (state_ == State::left) return false;
  // After close(), the outbox may have another membership.
  const bool is_member = state_ != State::closed;
  state_ = State::left;
  when_joined_.clear();
  if (!is_member) return true;
  if (feed_ != nullptr) std::exchange(feed_, nullptr)->remove(outbox_->id());
  outbox_->leave();
  return true;
}

void RelayedClient::close() {
  if (!end()) return;
  const std::lock_guard lock(mutex_);
  if (replies_due_ == 0) {
    line_->send(RelayKind::end);
  } else {
    state_ = State::closed;
    keeper_ = shared_from_this();
  }
}

void RelayedClient::count_reply() {
  std::shared_ptr<RelayedClient> keeper;
  const std::lock_guard lock(mutex_);
  if (replies_due_ > 0) --replies_due_;
  if (state_ != State::closed || replies_due_ > 0) return;
  state_ = State::left;
  keeper.swap(keeper_);
  line_->send(RelayKind::end);
}

void RelayedClient::abandon() {
  if (end()) line_->send(RelayKind::end);
}

void RelayedClient::fail() {
  const auto keep = weak_from_this().lock();
  std::optional<PendingReply> joining;
  std::optional<PendingReply> leaving;
  {
    const std::lock_guard lock(mutex_);
    joining.swap(joining_);
    leaving.swap(leaving_);
    keeper_.reset();
  }
  if (leaving) return leaving->answer(Json{{"tick", tick()}});
  if (!joining) {
    const Json where{{"session", place_.session}, {"url", ""}};  // again on this connection
    outbox_->send_event(membership_,
                        std::make_shared<const std::string>(write_event("session.moved", where)));
  }
  if (!end()) return;
  line_->send(RelayKind::end);
  if (joining) joining->answer(storage_failed(StorageError::Kind::unreachable));
}

}  // namespace vat
