#include "server/access/access.h"

#include <utility>

#include "server/storage/token_store.h"
#include "server/support/header_text.h"

namespace vat {
namespace {

using Seconds = std::chrono::duration<double>;

Role read_role(const std::string& name) {
  for (const Role role : {Role::viewer, Role::controller, Role::owner, Role::admin}) {
    if (name == to_string(role)) return role;
  }
  throw StorageError(StorageError::Kind::corrupt, "a stored token: its role");
}

}  // namespace

bool may_read_metrics(const AccessSettings& settings, std::string_view authorization) {
  if (settings.mode == AccessMode::open && !settings.metrics) return true;
  constexpr std::string_view kScheme = "Bearer ";
  if (!equal_ignoring_case(authorization.substr(0, kScheme.size()), kScheme)) return false;
  const TokenHash token = hash_of_token(authorization.substr(kScheme.size()));
  const auto is_given = [&](const std::optional<TokenHash>& valid) {
    return valid && are_same(*valid, token);
  };
  return is_given(settings.metrics) || is_given(settings.admin);
}

void AccessTokens::keep_in(TokenStore& store) {
  const auto now = clock_.now();
  const double wall = clock_.wall_time();
  store.remove_old(wall);
  const std::lock_guard lock(mutex_);
  store_ = &store;
  for (StoredToken& token : store.all()) {
    const auto left = std::chrono::duration_cast<SteadyClock::duration>(Seconds(token.ends - wall));
    Grant grant{read_role(token.role), std::move(token.session), true};
    entries_.insert_or_assign(token.hash, ValidToken{std::move(grant), token.uses, now + left});
    ++issued_;
  }
}

std::optional<std::string> AccessTokens::issue(Grant grant, std::optional<std::size_t> uses,
                                               std::chrono::seconds time) {
  std::string token = make_token();
  const TokenHash hash = hash_of_token(token);
  const std::lock_guard lock(mutex_);
  if (issued_ >= max_issued_) remove_old();
  if (issued_ >= max_issued_) return {};
  if (store_ != nullptr) {
    const double ends = clock_.wall_time() + Seconds(time).count();
    store_->add({hash, to_string(grant.role), grant.session, uses, ends});
  }
  entries_.insert_or_assign(hash, ValidToken{std::move(grant), uses, clock_.now() + time});
  ++issued_;
  return token;
}

void AccessTokens::add(const TokenHash& token, Grant grant) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(token, ValidToken{std::move(grant), {}, {}});
}

void AccessTokens::remove(const TokenHash& token) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(token);
  if (found == entries_.end()) return;
  if (found->second.end) --issued_;
  entries_.erase(found);
}

void AccessTokens::remove_session(const std::string& session, bool comes_back) {
  const std::lock_guard lock(mutex_);
  if (store_ != nullptr && !comes_back) store_->remove_session(session);
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_of_it = entry.second.grant.session == session;
    if (is_of_it && entry.second.end) --issued_;
    return is_of_it;
  });
}

std::optional<Grant> AccessTokens::use(const TokenHash& token) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(token);
  if (found == entries_.end()) return {};
  ValidToken& entry = found->second;
  if (entry.end && *entry.end <= clock_.now()) return {};
  Grant grant = entry.grant;
  if (entry.uses) count_use(token, entry);
  return grant;
}

void AccessTokens::count_use(const TokenHash& token, ValidToken& entry) {
  const std::size_t left = *entry.uses - 1;
  // First, so that a use counts even if the server ends meanwhile.
  if (store_ != nullptr && left > 0) store_->set_uses(token, left);
  if (store_ != nullptr && left == 0) store_->remove(token);
  entry.uses = left;
  if (left > 0) return;
  entries_.erase(token);
  --issued_;
}

void AccessTokens::remove_old() {
  if (store_ != nullptr) store_->remove_old(clock_.wall_time());
  const auto now = clock_.now();
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_old = entry.second.end && *entry.second.end <= now;
    if (is_old) --issued_;
    return is_old;
  });
}

}  // namespace vat
