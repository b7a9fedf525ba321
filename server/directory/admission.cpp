#include "server/directory/admission.h"

#include <algorithm>

#include "core/support/check.h"

namespace vat {

Admission::Admission(const ServerResources& resources, DirectoryTables& tables)
    : resources_(resources), tables_(tables) {}

void Admission::start_draining() {
  VAT_CHECK(has_lock());
  draining_ = true;
}

bool Admission::is_draining() const {
  VAT_CHECK(has_lock());
  return draining_;
}

bool Admission::admits_connection() const {
  VAT_CHECK(has_lock());
  return !stopped_ && !draining_ &&
         tables_.clients.size() < resources_.settings.limits.max_connections;
}

std::optional<RpcError> Admission::refuse_session() const {
  VAT_CHECK(has_lock());
  if (stopped_ || draining_) return not_allowed("the server is shutting down");
  const std::size_t maximum = resources_.settings.limits.max_sessions;
  if (tables_.sessions.size() < maximum) return {};
  return limit_reached("sessions", maximum);
}

std::variant<SessionCreator, RpcError> Admission::admit_creator(const PendingReply& reply) {
  VAT_CHECK(has_lock());
  const std::size_t maximum = resources_.settings.limits.max_sessions_per_address;
  const std::string& address = reply.client()->address();
  SessionCreator creator{reply.client()->id(), sessions_by_address_.take(address, maximum)};
  if (creator.place != nullptr) return creator;
  const auto abandoned = std::ranges::count_if(tables_.sessions.running(), [&](const auto& entry) {
    return tables_.sessions.is_from(entry.first, address) && is_abandoned(entry.first);
  });
  RpcError error = limit_reached("sessions_per_address", maximum);
  error.message += "; " + std::to_string(abandoned) + " of them are abandoned and can be closed";
  error.data["abandoned"] = abandoned;
  return error;
}

std::optional<RpcError> Admission::refuse_replay() const {
  VAT_CHECK(has_lock());
  const std::size_t maximum = resources_.settings.limits.max_replays;
  if (tables_.sessions.replay_count() < maximum) return {};
  return limit_reached("replays", maximum);
}

std::optional<RpcError> Admission::refuse_access(const Client& client,
                                                 SessionNumber session) const {
  const SessionId& own = client.access.session;
  if (client.unchecked && (own.empty() || tables_.sessions.running().contains(session))) {
    return not_allowed("the token is checked when the client joins a session");
  }
  if (own.empty() || own == to_id(session)) return {};
  return not_allowed("the token is for session " + own + " only");
}

std::optional<RpcError> Admission::refuse_role(const PendingReply& reply,
                                               SessionNumber session) const {
  VAT_CHECK(has_lock());
  const Client* client = tables_.clients.find(reply);
  if (client == nullptr) return not_allowed("the connection is closed");
  return vat::refuse_role(reply.method(), role_in(*client, session));
}

Role Admission::role_in(const Client& client, SessionNumber session) const {
  VAT_CHECK(has_lock());
  if (client.access.role == Role::admin) return Role::admin;
  const auto found = tables_.sessions.running().find(session);  // a lost one has no owner
  const bool is_creator = found != tables_.sessions.running().end() &&
                          found->second->summary().creator == client.outbox->id();
  if (is_creator) return Role::owner;
  if (client.session == session) return client.outbox->role();
  const bool is_invited = client.access.is_invitation && client.access.session == to_id(session);
  return is_invited ? client.access.role : Role::viewer;
}

bool Admission::is_abandoned(SessionNumber session) const {
  VAT_CHECK(has_lock());
  if (session == tables_.sessions.first()->first) return false;
  if (tables_.clients.count_in(session) > 0) return false;
  const SessionSummary summary = tables_.sessions.at(session).summary();
  return summary.empty_since.has_value() && tables_.clients.find(summary.creator) == nullptr;
}

bool Admission::may_close(const Client& client, SessionNumber session) const {
  VAT_CHECK(has_lock());
  if (refuse_access(client, session)) return false;
  if (role_in(client, session) >= Role::owner) return true;
  return client.access.role >= Role::controller &&
         tables_.sessions.is_from(session, client.outbox->address()) && is_abandoned(session);
}

RpcError Admission::refuse_missing(const Client& client, const SessionId& id) const {
  const auto* absent = tables_.sessions.find_absent(id);
  if (absent == nullptr || refuse_access(client, absent->first)) {
    return no_such_session(id, "/session");
  }
  return not_recovered(id, absent->second.is_lost ? "lost" : "recovering");
}

JoinRequest Admission::complete(JoinRequest request, const Client& client) const {
  const Grant& access = client.access;
  if (access.is_invitation) request.role = access.role;
  request.passes_lock =
      access.is_invitation && (access.role == Role::admin || !access.session.empty());
  return request;
}

Role Admission::default_role() const {
  return resources_.settings.access.mode == AccessMode::open ? Role::controller : Role::viewer;
}

}  // namespace vat
