#include "server/directory/access_control.h"

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
    resources_.deferred->add(resources_.clock.now() + access.enter_time,
                             [this, id = client.outbox->id()] { close_unless_entered(id); });
  }
}

std::optional<AccessTokens::Use> AccessControl::use_token(const TokenHash& token) {
  const auto& admin = resources_.settings.access.admin;
  if (admin && are_same(*admin, token)) return AccessTokens::Use{{Role::admin, {}, true}, {}, {}};
  return resources_.tokens.use(token);
}

std::optional<RpcResult> AccessControl::enter(PendingReply& reply, std::string_view token) {
  const AccessSettings& access = resources_.settings.access;
  const TokenHash hash = hash_of_token(token);
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(reply);
  if (client == nullptr) return not_allowed("the connection is closed");
  // After too many wrong tokens even a valid one is refused, also while the refusals are delayed.
  const bool may_try = client->wrong_tokens < access.max_wrong_tokens;
  if (const auto use = may_try ? use_token(hash) : std::nullopt) {
    // At once, because the client may have sent further requests already.
    const Grant before = std::exchange(client->access, use->grant);
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
  const bool is_last = ++client->wrong_tokens >= access.max_wrong_tokens;
  log_warning("a wrong token, number {} of its connection", client->wrong_tokens);
  resources_.deferred->add(
      resources_.clock.now() + access.refusal_delay,
      [is_last, refused = std::make_shared<PendingReply>(std::move(reply))] {
        refused->answer(not_authenticated("the token is invalid or has expired"));
        if (is_last) refused->client()->close(kNotAuthenticated, "too many wrong tokens");
      });
  return {};
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

}  // namespace vat
