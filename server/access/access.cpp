#include "server/access/access.h"

#include <cmath>
#include <utility>

#include "server/storage/journal.h"
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

void AccessTokens::keep_in(TokenStore& store, Journal& journal) {
  const auto now = clock_.now();
  const double wall = clock_.wall_time();
  store.remove_old(wall);
  const std::lock_guard lock(mutex_);
  store_ = &store;
  journal_ = &journal;
  for (StoredToken& token : store.all()) {
    const auto left = std::chrono::duration_cast<SteadyClock::duration>(Seconds(token.ends - wall));
    Grant grant{read_role(token.role), std::move(token.session), true};
    entries_.insert_or_assign(token.hash, ValidToken{std::move(grant), token.uses, now + left});
    ++issued_;
  }
}

void AccessTokens::share(SharedTokens& shared, TokenSigner signer) {
  shared_ = &shared;
  signer_.emplace(std::move(signer));
}

std::string AccessTokens::make_resume(const std::string& session) const {
  if (shared_ == nullptr) return make_token();
  return signer_->sign({TokenClaims::Kind::resume, Role::viewer, session, 0});
}

bool AccessTokens::is_signed(std::string_view token) const {
  return signer_ && TokenSigner::has_signature(token);
}

std::optional<TokenClaims> AccessTokens::verify(std::string_view token) const {
  if (!is_signed(token)) return {};
  return signer_->verify(token, clock_.wall_time());
}

void AccessTokens::use_shared(const TokenHash& token, const TokenClaims& claims,
                              std::function<void(SharedUse)> done) {
  shared_->use(token, claims, [claims, done = std::move(done)](const auto& outcome) {
    if (const auto* failure = std::get_if<StorageError::Kind>(&outcome)) {
      return done({{}, *failure});
    }
    if (!std::get<bool>(outcome)) return done({});
    done({Grant{claims.role, claims.session, true}, {}});
  });
}

template <class Write>
void AccessTokens::write(Write write) {
  if (store_ == nullptr) return;
  journal_->post([store = store_, write = std::move(write)] { write(*store); });
}

bool AccessTokens::insert(const TokenHash& hash, ValidToken token) {
  const std::lock_guard lock(mutex_);
  if (issued_ >= max_issued_) remove_old();
  if (issued_ >= max_issued_) return false;
  entries_.insert_or_assign(hash, std::move(token));
  ++issued_;
  return true;
}

void AccessTokens::issue(Grant grant, std::optional<std::size_t> uses, std::chrono::seconds time,
                         std::function<void(Issued)> done) {
  const double ends = clock_.wall_time() + Seconds(time).count();
  const TokenClaims claims{TokenClaims::Kind::grant, grant.role, grant.session,
                           static_cast<std::uint64_t>(std::ceil(ends))};
  const bool is_shared = shared_ != nullptr;
  const std::string token = is_shared ? signer_->sign(claims) : make_token();
  const TokenHash hash = hash_of_token(token);
  if (!insert(hash, ValidToken{grant, uses, clock_.now() + time})) return done({});
  auto finish = [this, hash, token, done = std::move(done)](auto failure) {
    if (!failure) return done({token, {}});
    remove(hash);
    done({{}, failure});
  };
  if (is_shared) return shared_->add(hash, claims, uses, std::move(finish));
  if (store_ == nullptr) return finish(std::optional<StorageError::Kind>());
  const StoredToken stored{hash, to_string(grant.role), grant.session, uses, ends};
  journal_->post([store = store_, stored] { store->add(stored); }, std::move(finish));
}

void AccessTokens::add(const TokenHash& token, Grant grant) {
  const std::lock_guard lock(mutex_);
  entries_.insert_or_assign(token, ValidToken{std::move(grant), {}, {}});
}

void AccessTokens::remove(const TokenHash& token) {
  const std::lock_guard lock(mutex_);
  erase(token);
}

void AccessTokens::erase(const TokenHash& token) {
  const auto found = entries_.find(token);
  if (found == entries_.end()) return;
  if (found->second.end) --issued_;
  entries_.erase(found);
}

void AccessTokens::remove_session(const std::string& session, bool comes_back) {
  const std::lock_guard lock(mutex_);
  if (!comes_back && shared_ != nullptr) shared_->remove_session(session);
  if (!comes_back) write([session](TokenStore& store) { store.remove_session(session); });
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_of_it = entry.second.grant.session == session;
    if (is_of_it && entry.second.end) --issued_;
    return is_of_it;
  });
}

std::optional<AccessTokens::Use> AccessTokens::use(const TokenHash& token) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(token);
  if (found == entries_.end()) return {};
  ValidToken& entry = found->second;
  if (entry.end && *entry.end <= clock_.now()) return {};
  if (entry.uses) --*entry.uses;
  Use use{entry.grant, entry.uses, entry.end};
  if (use.uses_left == std::size_t{0}) erase(token);
  return use;
}

void AccessTokens::store_use(const TokenHash& token, const Use& use,
                             std::function<void(std::optional<StorageError::Kind>)> done) {
  if (store_ == nullptr || !use.uses_left) return done({});
  journal_->post(
      [store = store_, token, left = *use.uses_left] {
        if (left > 0) {
          store->set_uses(token, left);
        } else {
          store->remove(token);
        }
      },
      [this, token, use, done = std::move(done)](auto failure) {
        if (failure) undo(token, use);
        done(failure);
      });
}

void AccessTokens::undo(const TokenHash& token, const Use& use) {
  const std::lock_guard lock(mutex_);
  const auto [entry, is_new] = entries_.try_emplace(token, ValidToken{use.grant, 0, use.end});
  ++*entry->second.uses;
  if (is_new) ++issued_;
}

void AccessTokens::remove_old() {
  write([now = clock_.wall_time()](TokenStore& store) { store.remove_old(now); });
  const auto now = clock_.now();
  std::erase_if(entries_, [&](const auto& entry) {
    const bool is_old = entry.second.end && *entry.second.end <= now;
    if (is_old) --issued_;
    return is_old;
  });
}

}  // namespace vat
