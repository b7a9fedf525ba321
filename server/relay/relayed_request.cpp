#include "server/relay/relayed_request.h"

#include <mutex>
#include <utility>

namespace vat {
namespace {

constexpr const char* kRequestId = "vat.request";

}  // namespace

RelayedRequest::RelayedRequest(RelayPlace place, std::unique_ptr<RelayLine> line, Links links,
                               const Clock& clock)
    : RelayEnd(std::move(place)),
      line_(std::move(line)),
      links_(std::move(links)),
      clock_(clock),
      heard_(clock.now()),
      asked_(clock.now()) {}

void RelayedRequest::send(PendingReply reply, const RelayEntry& entry, std::string_view method,
                          const Json& params) {
  const std::string address = reply.client()->address();
  const bool has_token = !entry.token.empty();
  std::string text = write_owner_request(kRequestId, method, params);
  {
    const std::lock_guard lock(mutex_);
    granted_ = entry.granted;
    reply_ = std::move(reply);
    keeper_ = shared_from_this();
    if (has_token) request_ = text;
  }
  if (!send_entry(*line_, place(), address, entry)) return fail();
  if (!has_token) send_text(std::move(text));
}

void RelayedRequest::send_text(std::string text) {
  if (!line_->send(RelayKind::text, Json::object(), std::move(text))) fail();
}

void RelayedRequest::receive(RelayMessage message) {
  RelayInput::Taken taken{};
  {
    const std::lock_guard lock(mutex_);
    if (!reply_) return;
    heard_ = clock_.now();
    taken = received_.take(message);
  }
  if (taken == RelayInput::Taken::part) return;
  const bool has_ended = taken == RelayInput::Taken::lost || message.kind == RelayKind::end;
  if (has_ended) return fail();
  if (message.kind == RelayKind::text) receive_text(message.body);
}

void RelayedRequest::receive_text(const std::string& text) {
  const Json message = Json::parse(text);
  const auto id = message.find("id");
  if (id == message.end()) return;  // an event of the other node
  if (*id == kEnterId) return finish_enter(message);
  if (*id == kRequestId) finish(read_result(message));
}

void RelayedRequest::finish_enter(const Json& message) {
  if (const auto error = message.find("error"); error != message.end()) {
    return finish(read_owner_error(*error));
  }
  std::function<void(const Grant&)> granted;
  std::string request;
  {
    const std::lock_guard lock(mutex_);
    granted = granted_;
    request = request_;
  }
  if (granted) granted(read_granted(message.at("result")));
  send_text(std::move(request));
}

RpcResult RelayedRequest::read_result(const Json& message) const {
  const auto error = message.find("error");
  if (error == message.end()) {
    Json result = message.at("result");
    if (links_.note_result) links_.note_result(result);
    return result;
  }
  RpcError answer = read_owner_error(*error);
  if (answer.kind != ErrorKind::moved) return answer;
  links_.note_move();
  return moved_to(place().session, place().own_url);
}

void RelayedRequest::finish(RpcResult result) {
  std::shared_ptr<RelayedRequest> keeper;
  std::optional<PendingReply> reply;
  {
    const std::lock_guard lock(mutex_);
    reply.swap(reply_);
    keeper.swap(keeper_);
  }
  if (!reply) return;
  line_->send(RelayKind::end);
  reply->answer(result);
}

void RelayedRequest::fail() {
  finish(storage_failed(StorageError::Kind::unreachable));
}

void RelayedRequest::look() {
  bool is_silent = false;
  bool asks = false;
  {
    const std::lock_guard lock(mutex_);
    if (!reply_) return;
    const auto now = clock_.now();
    is_silent = now - heard_ > kOwnerSilence;
    asks = now - asked_ > kQuestionInterval;
    if (asks) asked_ = now;
  }
  if (is_silent) return fail();
  if (asks && !line_->send(RelayKind::alive, {{"subject", place().subject}})) fail();
}

}  // namespace vat
