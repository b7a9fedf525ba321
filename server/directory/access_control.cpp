#include "server/directory/access_control.h"

#include <boost/asio/post.hpp>
#include <memory>
#include <utility>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::uint16_t kNotAuthenticated = 4001;

}  // namespace

AccessControl::AccessControl(ServerResources& resources, DirectoryTables& tables,
                             const Admission& admission)
    : resources_(resources), tables_(tables), admission_(admission) {}

void AccessControl::start(Client& client) {
  VAT_CHECK(tables_.mutex.is_held());
  const AccessSettings& access = resources_.settings.access;
  if (access.mode == AccessMode::open) {
    client.access.role = Role::controller;
  } else {
    limit_enter_time(client.outbox->id());
  }
}

void AccessControl::limit_enter_time(ConnectionId id) {
  resources_.deferred->add(resources_.clock.now() + resources_.settings.access.enter_time,
                           [this, id] { close_unless_entered(id); });
}

std::optional<AccessTokens::Use> AccessControl::use_token(std::string_view token,
                                                          const TokenHash& hash) {
  const auto& admin = resources_.settings.access.admin;
  if (admin && are_same(*admin, hash)) return AccessTokens::Use{{Role::admin, {}, true}, {}, {}};
  if (resources_.tokens.is_signed(token)) {
    // The uses of a signed invitation or ticket are not counted here.
    const auto claims = resources_.tokens.verify(token);
    if (!claims || claims->kind != TokenClaims::Kind::resume) return {};
  }
  return resources_.tokens.use(hash);
}

std::optional<TokenClaims> AccessControl::claims_to_check(std::string_view token) const {
  const auto claims = resources_.tokens.verify(token);
  if (!claims || claims->session.empty()) return claims;
  const bool runs_here = tables_.sessions.find(claims->session) != nullptr;
  if (runs_here && claims->kind == TokenClaims::Kind::resume) return {};  // this node knows it
  const auto number = number_of(claims->session);
  const bool is_known = runs_here || tables_.sessions.find_absent(claims->session) != nullptr ||
                        (number && resources_.cluster->find(*number));
  return is_known ? claims : std::nullopt;
}

std::optional<RpcResult> AccessControl::enter(PendingReply& reply, std::string_view token) {
  const AccessSettings& access = resources_.settings.access;
  const TokenHash hash = hash_of_token(token);
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(reply);
  if (client == nullptr) return not_allowed("the connection is closed");
  if (!client->checks.empty()) return not_allowed("the previous token is still being checked");
  // After too many wrong tokens even a valid one is refused, also while the refusals are delayed.
  const bool may_try = client->wrong_tokens < access.max_wrong_tokens;
  if (auto claims = may_try ? claims_to_check(token) : std::nullopt) {
    return enter_unchecked(reply, *client, {std::string(token), hash, *std::move(claims), {}});
  }
  if (const auto use = may_try ? use_token(token, hash) : std::nullopt) {
    // At once, because the client may have sent further requests already.
    const Grant before = std::exchange(client->access, use->grant);
    client->unchecked.reset();
    // The owner of a relayed session grants the same access, also to a client that has joined.
    if (use->grant.role == Role::admin && client->relay) client->relay->enter(std::string(token));
    Json answer{{"role", to_string(use->grant.role)}};
    if (!use->grant.session.empty()) answer["session"] = use->grant.session;
    resources_.tokens.store_use(
        hash, *use,
        [this, before, answer = std::move(answer),
         waiting = std::make_shared<PendingReply>(std::move(reply))](auto failure) {
          if (!failure) return waiting->answer(answer);
          withdraw(waiting->client()->id(), before);
          waiting->answer(storage_failed(*failure));
        });
    return {};
  }
  refuse_token(*client, std::move(reply));
  return {};
}

std::optional<RpcResult> AccessControl::enter_unchecked(PendingReply& reply, Client& client,
                                                        UncheckedToken token) {
  const TokenClaims& claims = token.claims;
  Json answer{{"role", to_string(claims.role)}};
  if (!claims.session.empty()) answer["session"] = claims.session;
  token.before = client.unchecked ? client.unchecked->before : client.access;
  client.access = {Role::viewer, claims.session, false};
  client.unchecked = std::move(token);
  if (!must_check(client)) return answer;
  check_then(client, [this, answer = std::move(answer),
                      waiting = std::make_shared<PendingReply>(std::move(reply))](auto error) {
    if (!error) return waiting->answer(answer);
    if (error->kind != ErrorKind::not_authenticated) return waiting->answer(*error);
    const std::lock_guard lock(tables_.mutex);
    Client* const refused = tables_.clients.find(*waiting);
    if (refused != nullptr) refuse_token(*refused, std::move(*waiting));
  });
  return {};
}

bool AccessControl::must_check(const Client& client) const {
  VAT_CHECK(tables_.mutex.is_held());
  if (!client.unchecked) return false;
  const std::string& session = client.unchecked->claims.session;
  return session.empty() || tables_.sessions.find(session) != nullptr;
}

void AccessControl::check_then(Client& client, std::function<void(std::optional<RpcError>)> then) {
  VAT_CHECK(must_check(client));
  const bool is_running = !client.checks.empty();
  client.checks.push_back(std::move(then));
  if (is_running) return;
  const ConnectionId id = client.outbox->id();
  const UncheckedToken& token = *client.unchecked;
  if (token.claims.kind == TokenClaims::Kind::grant) {
    return resources_.tokens.use_shared(
        token.hash, token.claims,
        [this, id](const AccessTokens::SharedUse& use) { finish_check(id, use); });
  }
  boost::asio::post(resources_.pool, [this, id, hash = token.hash] {
    const auto use = resources_.tokens.use(hash);
    finish_check(id, {use ? std::optional(use->grant) : std::nullopt, {}});
  });
}

void AccessControl::finish_check(ConnectionId id, const AccessTokens::SharedUse& use) {
  std::vector<std::function<void(std::optional<RpcError>)>> waiting;
  std::optional<RpcError> error;
  {
    const std::lock_guard lock(tables_.mutex);
    Client* const client = tables_.clients.find(id);
    if (client == nullptr) return;
    VAT_CHECK(client->unchecked.has_value());
    waiting.swap(client->checks);
    if (use.failure) {
      error = storage_failed(*use.failure);  // a later request checks the token again
    } else {
      client->access = use.grant ? *use.grant : client->unchecked->before;
      client->unchecked.reset();
      if (!use.grant) error = not_authenticated("the token is invalid or has expired");
      if (client->access.role == Role::none) limit_enter_time(id);
    }
  }
  for (const auto& then : waiting) then(error);
}

void AccessControl::refuse_token(Client& client, PendingReply reply) {
  VAT_CHECK(tables_.mutex.is_held());
  const AccessSettings& access = resources_.settings.access;
  const bool is_last = ++client.wrong_tokens >= access.max_wrong_tokens;
  log_warning("a wrong token, number {} of its connection", client.wrong_tokens);
  resources_.deferred->add(
      resources_.clock.now() + access.refusal_delay,
      [is_last, refused = std::make_shared<PendingReply>(std::move(reply))] {
        refused->answer(not_authenticated("the token is invalid or has expired"));
        if (is_last) refused->client()->close(kNotAuthenticated, "too many wrong tokens");
      });
}

void AccessControl::close_unless_entered(ConnectionId id) {
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(id);
  if (client == nullptr || client->access.role != Role::none) return;
  client->outbox->close(kNotAuthenticated, "no token was shown in time");
}

void AccessControl::withdraw(ConnectionId id, const Grant& before) {
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(id);
  if (client != nullptr && client->session == 0) client->access = before;
}

std::optional<RpcError> AccessControl::issue_ticket(PendingReply& reply, Role role,
                                                    const std::optional<SessionId>& session) {
  Grant grant{role, session.value_or(""), true};
  {
    const std::lock_guard lock(tables_.mutex);
    const Client* client = tables_.clients.find(reply);
    if (client == nullptr) return not_allowed("the connection is closed");
    if (!session && client->access.role < Role::admin) {
      return role_too_low(reply.method().name, client->access.role, Role::admin);
    }
    if (session) {
      const auto* found = tables_.sessions.find(*session);
      if (found == nullptr) return admission_.refuse_missing(*client, *session);
      if (auto error = admission_.refuse_role(reply, found->first)) return error;
    }
  }
  const auto time = resources_.settings.access.ticket_time;
  resources_.tokens.issue(
      std::move(grant), 1, time,
      [role, time, maximum = resources_.settings.limits.max_tokens,
       waiting =
           std::make_shared<PendingReply>(std::move(reply))](const AccessTokens::Issued& issued) {
        if (issued.failure) return waiting->answer(storage_failed(*issued.failure));
        if (!issued.token) return waiting->answer(limit_reached("tokens", maximum));
        waiting->answer(
            Json{{"token", *issued.token}, {"role", to_string(role)}, {"seconds", time.count()}});
      });
  return {};
}

void AccessControl::answer_created(PendingReply& reply, RpcResult result) {
  auto* const created = std::get_if<Json>(&result);
  bool is_relayed = false;
  {
    const std::lock_guard lock(tables_.mutex);
    const Client* client = tables_.clients.find(reply);
    is_relayed = client != nullptr && client->is_relayed;
  }
  if (created == nullptr || created->contains("ticket") || !is_relayed) {
    return reply.answer(result);
  }
  Grant grant{Role::owner, created->at("session"), true};
  resources_.tokens.issue(
      std::move(grant), 1, resources_.settings.access.ticket_time,
      [content = std::move(*created), waiting = std::make_shared<PendingReply>(std::move(reply))](
          const AccessTokens::Issued& issued) mutable {
        if (issued.token) content["ticket"] = *issued.token;
        waiting->answer(content);
      });
}

}  // namespace vat
