#include "protocol/client/exchange/call_list.h"

#include <algorithm>
#include <utility>

namespace vat::client {
namespace {

std::string message_text(const std::string& method, const Json& params,
                         std::optional<std::int64_t> id) try {
  Json message = {{"jsonrpc", "2.0"}, {"method", method}};
  if (id) message["id"] = *id;
  if (!params.empty()) message["params"] = params;
  return message.dump();
} catch (const Json::exception&) {
  throw std::invalid_argument(method + ": a text in the params is not UTF-8");
}

}  // namespace

std::optional<CallError> CallList::add(Call call, Origin origin) {
  const std::lock_guard lock(mutex_);
  if (!is_open_ && origin == Origin::application) {
    return CallError("disconnected", call.method + ": there is no connection to the server");
  }
  if (calls_.size() >= kMaxCalls || !has_room()) {
    return CallError("too_many_calls", call.method + ": too many calls wait, at most " +
                                           std::to_string(kMaxCalls) + " and " +
                                           std::to_string(kMaxOutputBytes) + " bytes");
  }
  put(message_text(call.method, call.params, last_id_ + 1));
  calls_.emplace(++last_id_, std::move(call));
  return {};
}

bool CallList::add_notification(const std::string& method, const Json& params, Origin origin) {
  const std::lock_guard lock(mutex_);
  if ((!is_open_ && origin == Origin::application) || !has_room()) return false;
  put(message_text(method, params, {}));
  return true;
}

std::optional<Call> CallList::take(std::int64_t id) {
  const std::lock_guard lock(mutex_);
  auto node = calls_.extract(id);
  if (node.empty()) return {};
  return std::move(node.mapped());
}

std::vector<Call> CallList::take_expired(Time now) {
  const std::lock_guard lock(mutex_);
  std::vector<Call> expired;
  for (auto it = calls_.begin(); it != calls_.end();) {
    const bool is_late = it->second.deadline <= now;
    if (is_late) expired.push_back(std::move(it->second));
    it = is_late ? calls_.erase(it) : std::next(it);
  }
  return expired;
}

std::vector<Call> CallList::close() {
  const std::lock_guard lock(mutex_);
  is_open_ = false;
  output_.clear();
  output_bytes_ = 0;
  std::vector<Call> all;
  for (auto& [id, call] : calls_) all.push_back(std::move(call));
  calls_.clear();
  return all;
}

void CallList::open() {
  const std::lock_guard lock(mutex_);
  is_open_ = true;
}

Time CallList::next_deadline() const {
  const std::lock_guard lock(mutex_);
  Time next = Time::max();
  for (const auto& [id, call] : calls_) next = std::min(next, call.deadline);
  return next;
}

std::vector<std::string> CallList::take_output() {
  const std::lock_guard lock(mutex_);
  output_bytes_ = 0;
  return std::exchange(output_, {});
}

void CallList::put(std::string text) {
  output_bytes_ += text.size();
  output_.push_back(std::move(text));
}

}  // namespace vat::client
