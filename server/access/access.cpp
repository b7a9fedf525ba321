#include "server/access/access.h"

#include <utility>

namespace vat {

const char* to_string(AccessMode mode) {
  return mode == AccessMode::open ? "open" : "token";
}

std::optional<std::string> AccessTokens::issue(Grant grant, std::optional<std::size_t> uses,
                                               Clock::time_point end, Clock::time_point now) {
  std::string token = make_token();
  const std::lock_guard lock(mutex_);
  if (issued_ >= max_issued_) remove_old(now);
  if (issued_ >= max_issued_) return {};
  entries_.insert_or_assign(hash_of_token(token), Entry{std::move(grant), uses, end});
  ++issued_;
  return token;
}

void AccessTokens::add(const TokenHash& token, Grant grant) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(token, Entry{std::move(grant), {}, {}});
}

void AccessTokens::remove(const TokenHash& token) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(token);
  if (found == entries_.end()) return;
  if (found->second.end) --issued_;
  entries_.erase(found);
}

void AccessTokens::remove_session(std::string_view session) {
  const std::lock_guard lock(mutex_);
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_of_it = entry.second.grant.session == session;
    if (is_of_it && entry.second.end) --issued_;
    return is_of_it;
  });
}

std::optional<Grant> AccessTokens::use(const TokenHash& token, Clock::time_point now) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(token);
  if (found == entries_.end()) return {};
  Entry& entry = found->second;
  if (entry.end && *entry.end <= now) return {};
  Grant grant = entry.grant;
  if (entry.uses && --*entry.uses == 0) {
    entries_.erase(found);
    --issued_;
  }
  return grant;
}

void AccessTokens::remove_old(Clock::time_point now) {
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_old = entry.second.end && *entry.second.end <= now;
    if (is_old) --issued_;
    return is_old;
  });
}

}  // namespace vat
