// Who is let in by the server, and with what.

#include <spdlog/spdlog.h>

#include <string>
#include <utility>

#include "server/session/session_directory.h"

namespace vat {
namespace {

constexpr std::uint16_t kNotAuthenticated = 4001;

}  // namespace

std::optional<Grant> SessionDirectory::find_grant(std::string_view token) {
  const TokenHash hash = hash_of_token(token);
  const auto& admin = settings_.access.admin;
  if (admin && are_same(*admin, hash)) return Grant{Role::admin, {}, true};
  return tokens_.use(hash);
}

std::optional<RpcResult> SessionDirectory::enter(PendingReply& caller, std::string_view token) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(caller.client()->id());
  if (found == clients_.end()) return not_allowed("the connection is closed");
  Client& client = found->second;
  // Who has guessed too often is not heard any more, also where the answers are still to come.
  const bool is_heard = client.wrong_tokens < settings_.access.max_wrong_tokens;
  if (const auto grant = is_heard ? find_grant(token) : std::nullopt) {
    client.access = *grant;
    Json answer{{"role", to_string(grant->role)}};
    if (!grant->session.empty()) answer["session"] = grant->session;
    return answer;
  }
  const bool is_last = ++client.wrong_tokens >= settings_.access.max_wrong_tokens;
  spdlog::warn("a wrong token, number {} of its connection", client.wrong_tokens);
  deferred_->add(clock_.now() + settings_.access.refusal_delay,
                 [is_last, refused = std::make_shared<PendingReply>(std::move(caller))] {
                   refused->answer(not_authenticated("the token is not good, or not any more"));
                   if (is_last)
                     refused->client()->close(kNotAuthenticated, "too many wrong tokens");
                 });
  return {};
}

void SessionDirectory::close_unless_entered(ConnectionId id) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(id);
  if (client == clients_.end() || client->second.access.role != Role::none) return;
  client->second.outbox->close(kNotAuthenticated, "no token was shown in time");
}

RpcResult SessionDirectory::issue_ticket(const PendingReply& caller, Role role,
                                         const std::optional<SessionId>& session) {
  const MethodRules& rules = rules_of("access.ticket");
  Grant grant{role, session.value_or(""), true};
  {
    const std::lock_guard lock(mutex_);
    const Client* client = find_caller(caller);
    if (client == nullptr) return not_allowed("the connection is closed");
    if (!session && client->access.role < Role::admin) {
      return role_too_low(rules.method, client->access.role, Role::admin);
    }
    if (session) {
      const auto found = find_session(*session);
      if (found == sessions_.end()) return refuse_missing(*client, *session);
      if (auto error = refuse_role(caller, rules, found->first)) return *std::move(error);
    }
  }
  const auto time = settings_.access.ticket_time;
  const auto token = tokens_.issue(std::move(grant), 1, time);
  if (!token) return limit_reached("tokens", settings_.limits.max_tokens);
  return Json{{"token", *token}, {"role", to_string(role)}, {"seconds", time.count()}};
}

void SessionDirectory::undo_join(ConnectionId id, Sessions::key_type session) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(id);
  if (client == clients_.end() || client->second.session != session) return;
  client->second.outbox->leave();
  client->second.session = 0;
}

const SessionDirectory::Client* SessionDirectory::find_caller(const PendingReply& caller) const {
  const auto client = clients_.find(caller.client()->id());
  return client == clients_.end() ? nullptr : &client->second;
}

std::optional<RpcError> SessionDirectory::refuse_role(const PendingReply& caller,
                                                      const MethodRules& rules,
                                                      Sessions::key_type session) const {
  const Client* client = find_caller(caller);
  if (client == nullptr) return not_allowed("the connection is closed");
  Role role = client->access.role;
  if (role != Role::admin) {
    const bool is_in = client->session == session;
    const auto found = sessions_.find(session);  // one that is not back has no owner here
    const bool is_creator =
        found != sessions_.end() && found->second->summary().creator == caller.client()->id();
    role = is_creator ? Role::owner : is_in ? client->outbox->role() : Role::viewer;
  }
  return vat::refuse_role(rules, role);
}

std::optional<RpcError> SessionDirectory::refuse_access(const Client& client,
                                                        Sessions::key_type session) const {
  const SessionId& own = client.access.session;
  if (own.empty() || own == to_id(session)) return {};
  return not_allowed("the token is for session " + own + " only");
}

JoinRequest SessionDirectory::complete(JoinRequest join_request, const Client& client) const {
  const Grant& access = client.access;
  if (access.is_invitation) join_request.role = access.role;
  join_request.passes_lock =
      access.is_invitation && (access.role == Role::admin || !access.session.empty());
  return join_request;
}

}  // namespace vat
