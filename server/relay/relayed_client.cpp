#include "server/relay/relayed_client.h"

#include <algorithm>
#include <charconv>
#include <mutex>
#include <utility>

#include "core/support/check.h"
#include "server/access/role.h"

namespace vat {
namespace {

constexpr const char* kJoinId = "vat.join";
constexpr const char* kLeaveId = "vat.leave";
constexpr std::string_view kEventStart = R"({"jsonrpc":"2.0","method":")";
// Close codes of PROTOCOL.md that a client answers by joining again.
constexpr std::uint16_t kGoingAway = 1001;
constexpr std::uint16_t kNotOwner = 4012;

/// Returns the name of the event, or nothing if the text is a reply.
std::string_view event_of(std::string_view text) {
  if (!text.starts_with(kEventStart)) return {};
  text.remove_prefix(kEventStart.size());
  return text.substr(0, text.find('"'));
}

/// Returns the member `epoch` of a description, which is long.
std::uint32_t epoch_of(std::string_view description) {
  constexpr std::string_view kName = R"("epoch":)";
  std::uint32_t epoch = 0;
  const auto at = description.find(kName);  // quotation marks in names are escaped
  VAT_CHECK(at != std::string_view::npos);
  const char* const begin = description.data() + at + kName.size();
  std::from_chars(begin, description.data() + description.size(), epoch);
  return epoch;
}

}  // namespace

RelayedClient::RelayedClient(RelayPlace place, std::unique_ptr<RelayLine> line,
                             std::shared_ptr<ClientOutbox> outbox, Links links, const Clock& clock)
    : RelayEnd(std::move(place)),
      line_(std::move(line)),
      outbox_(std::move(outbox)),
      links_(std::move(links)),
      clock_(clock),
      membership_(outbox_->join()),
      heard_(clock.now()),
      asked_(clock.now()) {}

RelayedClient::~RelayedClient() {
  abandon();
}

void RelayedClient::join(PendingReply reply, RelayEntry entry, const Json& params) {
  {
    const std::lock_guard lock(mutex_);
    joining_ = std::move(reply);
    tokens_shown_ = entry.token.empty() ? 0 : 1;
    granted_ = entry.granted;
  }
  if (!send_entry(*line_, place(), outbox_->address(), entry)) return fail();
  send(RelayKind::text, Json::object(), write_owner_request(kJoinId, "session.join", params));
}

bool RelayedClient::forward(std::string_view message, const std::optional<Json>& id,
                            NoteResult note_result) {
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::left || state_ == State::closed) return false;
    replies_due_ += id ? 1 : 0;
    if (id && note_result) noted_.emplace_back(*id, std::move(note_result));
  }
  send(RelayKind::text, Json::object(), std::string(message));
  return true;
}

void RelayedClient::enter(const std::string& token) {
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::left || state_ == State::closed) return;
    ++tokens_shown_;
  }
  send(RelayKind::text, Json::object(), write_enter(token));
}

void RelayedClient::send(RelayKind kind, Json fields, std::string body) {
  if (!line_->send(kind, std::move(fields), std::move(body))) fail();
}

void RelayedClient::when_joined(Task task) {
  State state = State::left;
  {
    const std::lock_guard lock(mutex_);
    state = state_;
    if (state == State::joining) when_joined_.push_back(std::move(task));
  }
  if (state != State::joining) task(state == State::joined);
}

void RelayedClient::leave(PendingReply reply) {
  when_joined([self = shared_from_this(),
               waiting = std::make_shared<PendingReply>(std::move(reply))](bool has_joined) {
    if (!has_joined) return waiting->answer(not_joined());
    {
      const std::lock_guard lock(self->mutex_);
      self->leaving_ = std::move(*waiting);
      self->keeper_ = self;
    }
    self->end();
    self->send(RelayKind::text, Json::object(),
               write_owner_request(kLeaveId, "session.leave", Json::object()));
  });
}

void RelayedClient::subscribe(PendingReply reply, const Subscription& wanted) {
  when_joined(
      [this, wanted, waiting = std::make_shared<PendingReply>(std::move(reply))](bool has_joined) {
        if (!has_joined) return waiting->answer(not_joined());
        const auto feed = links_.feed();
        const std::lock_guard lock(mutex_);
        if (state_ != State::joined) return waiting->answer(not_joined());
        if (feed_ != nullptr && feed_ != feed) feed_->remove(outbox_->id());
        feed_ = feed;
        const std::uint64_t number = outbox_->subscribe(membership_, feed->frames(), clock_.now());
        if (number == 0) return waiting->answer(not_joined());
        feed->add(outbox_, number, wanted);
        waiting->answer(Json{{"tick", tick_locked()}});
      });
}

void RelayedClient::unsubscribe(PendingReply reply) {
  when_joined([this, waiting = std::make_shared<PendingReply>(std::move(reply))](bool has_joined) {
    if (!has_joined) return waiting->answer(not_joined());
    const std::lock_guard lock(mutex_);
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
    heard_ = clock_.now();
    taken = received_.take(message);
  }
  if (taken == RelayInput::Taken::part) return;
  if (taken == RelayInput::Taken::lost) return fail();
  if (message.kind == RelayKind::text) return receive_text(message.body);
  if (message.kind == RelayKind::end) receive_end(message.fields);
}

void RelayedClient::receive_end(const Json& fields) {
  const auto code = fields.value("code", kGoingAway);
  if (code == kGoingAway || code == kNotOwner) return fail();
  if (end()) outbox_->close(code, fields.value("reason", std::string()));
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
  // Not before the event, so that no frame of the epoch is sent earlier.
  if (event == "session.description") start_epoch(epoch_of(text));
  if (event == "session.closed") close();
}

void RelayedClient::start_epoch(std::uint32_t epoch) {
  outbox_->start_epoch(membership_, epoch);
  const std::lock_guard lock(mutex_);
  if (feed_ != nullptr) feed_->repeat(outbox_->id());  // the frames may have been faster
}

bool RelayedClient::receive_reply(const std::string& text) {
  {
    const std::lock_guard lock(mutex_);
    if (!joining_ && !leaving_ && tokens_shown_ == 0 && noted_.empty()) return false;
  }
  Json message = Json::parse(text);
  const Json& id = message.at("id");
  const auto keep = shared_from_this();
  std::unique_lock lock(mutex_);
  if (id == kEnterId && tokens_shown_ > 0) {  // may follow the reply to the join
    --tokens_shown_;
    lock.unlock();
    finish_enter(message);
  } else if (id == kJoinId && joining_) {
    lock.unlock();
    finish_join(message);
  } else if (id == kLeaveId && leaving_) {
    leaving_->answer(message.value("result", Json::object()));
    leaving_.reset();
    keeper_.reset();
    line_->send(RelayKind::end);
  } else {
    lock.unlock();
    return note_result(message);
  }
  return true;
}

bool RelayedClient::note_result(Json& message) {
  NoteResult note;
  {
    const std::lock_guard lock(mutex_);
    const auto found =
        std::ranges::find(noted_, message.at("id"), &std::pair<Json, NoteResult>::first);
    if (found == noted_.end()) return false;
    note = std::move(found->second);
    noted_.erase(found);
  }
  const auto result = message.find("result");
  if (result == message.end()) return false;
  note(*result);
  outbox_->send(to_message_text(message));
  count_reply();
  return true;
}

void RelayedClient::finish_enter(const Json& message) {
  if (const auto error = message.find("error"); error != message.end()) {
    return fail_join(read_owner_error(*error));
  }
  std::function<void(const Grant&)> granted;
  {
    const std::lock_guard lock(mutex_);
    granted = granted_;
  }
  if (granted) granted(read_granted(message.at("result")));
}

void RelayedClient::fail_join(RpcError error) {
  std::optional<PendingReply> reply;
  std::vector<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    if (!joining_) return;
    reply.swap(joining_);
    tasks.swap(when_joined_);
  }
  const bool has_ended = end();
  if (has_ended) line_->send(RelayKind::end);
  reply->answer(std::move(error));
  for (const Task& task : tasks) task(false);
}

void RelayedClient::finish_join(const Json& message) {
  if (const auto error = message.find("error"); error != message.end()) {
    RpcError answer = read_owner_error(*error);
    if (answer.kind == ErrorKind::moved) {
      links_.note_move();
      answer = moved_to(place().session, place().own_url);
    }
    return fail_join(std::move(answer));
  }
  const Json& result = message.at("result");
  std::vector<Task> tasks;
  {
    const std::lock_guard lock(mutex_);
    if (state_ != State::joining || !joining_) return;
    state_ = State::joined;
    joined_tick_ = result.at("tick");
    outbox_->set_role(membership_, read_owner_role(result.at("role")));
    outbox_->start_epoch(membership_, result.at("description").at("epoch"));
    joining_->answer(result);
    joining_.reset();
    tasks.swap(when_joined_);
  }
  for (const Task& task : tasks) task(true);
}

bool RelayedClient::end() {
  const std::lock_guard lock(mutex_);
  if (state_ == State::left) return false;
  // After close(), the outbox may have another membership.
  const bool is_member = state_ != State::closed;
  state_ = State::left;
  if (!is_member) return true;
  if (feed_ != nullptr) std::exchange(feed_, nullptr)->remove(outbox_->id());
  outbox_->leave(membership_);
  return true;
}

void RelayedClient::close() {
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::joining) return;  // the reply to the join follows
  }
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
  std::vector<Task> dropped;  // they may own this client
  const auto keep = weak_from_this().lock();
  {
    const std::lock_guard lock(mutex_);
    dropped.swap(when_joined_);
  }
  if (end()) line_->send(RelayKind::end);
}

void RelayedClient::fail() {
  const auto keep = weak_from_this().lock();
  std::optional<PendingReply> leaving;
  State state{};
  {
    const std::lock_guard lock(mutex_);
    leaving.swap(leaving_);
    keeper_.reset();
    state = state_;
  }
  if (leaving) {
    line_->send(RelayKind::end);
    return leaving->answer(Json{{"tick", tick()}});
  }
  if (state == State::joining) {
    return fail_join(storage_failed(StorageError::Kind::unreachable));
  }
  if (!end()) return;
  line_->send(RelayKind::end);
  if (state == State::closed) return;
  // Without a URL: the client joins again on this connection.
  outbox_->send(write_event("session.moved", {{"session", place().session}, {"url", ""}}));
}

void RelayedClient::look() {
  bool is_silent = false;
  bool asks = false;
  {
    const std::lock_guard lock(mutex_);
    if (state_ == State::left && !leaving_) return;
    const auto now = clock_.now();
    is_silent = now - heard_ > kOwnerSilence;
    asks = now - asked_ > kQuestionInterval;
    if (asks) asked_ = now;
  }
  if (is_silent) return fail();
  if (asks) send(RelayKind::alive, {{"subject", place().subject}}, {});
}

}  // namespace vat
