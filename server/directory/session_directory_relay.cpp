// Clients of this node in sessions of other nodes, and viewers at other nodes.

#include <utility>

#include "core/support/check.h"
#include "server/directory/session_directory.h"

namespace vat {

bool SessionDirectory::can_relay(const LocatedSession& session) const {
  return resources_.cluster->accepts(session.owner) &&
         !resources_.relay->has_moved(to_id(session.number), session.epoch);
}

void SessionDirectory::join_by_relay(Client& client, PendingReply& reply,
                                     const LocatedSession& session, const JoinRequest& request) {
  VAT_CHECK(tables_.mutex.is_held());
  const SessionId id = to_id(session.number);
  leave_session(client, PendingReply(client.outbox, {}));
  Json params{{"session", id}};
  if (!request.name.empty()) params["name"] = request.name;
  if (request.resume) params["resume"] = *request.resume;
  if (request.greatest_role) params["role"] = to_string(*request.greatest_role);
  client.relay = resources_.relay->open(client.outbox, id, {session.owner, session.epoch});
  client.relay->join(std::move(reply), entry_for(client, id, request.resume), params);
}

RelayEntry SessionDirectory::entry_for(const Client& client, const SessionId& id,
                                       const std::optional<std::string>& resume) {
  VAT_CHECK(tables_.mutex.is_held());
  RelayEntry entry;
  entry.access = client.unchecked ? client.unchecked->before : client.access;
  entry.is_open = resources_.settings.access.mode == AccessMode::open;
  entry.granted = [this, id, connection = client.outbox->id()](const Grant& grant) {
    note_granted(connection, id, grant);
  };
  if (client.access.role == Role::admin) return entry;
  const auto ticket = client.tickets.find(id);
  const auto granted = client.relay_access.find(id);
  if (granted != client.relay_access.end()) {
    entry.access = granted->second;
  } else if (resume && client.unchecked) {
    entry.token = *resume;  // does not count as a use
  } else if (ticket != client.tickets.end()) {
    entry.token = ticket->second;
  } else if (client.unchecked) {
    entry.token = client.unchecked->token;
  }
  return entry;
}

bool SessionDirectory::ask_owner(PendingReply& reply, const RpcRequest& request) {
  const auto named = request.params.find("session");
  if (resources_.cluster == nullptr || named == request.params.end() || !named->is_string()) {
    return false;
  }
  const SessionId id = named->get<SessionId>();
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(reply);
  const bool is_here = tables_.sessions.find(id) != nullptr || tables_.sessions.find_absent(id);
  const auto located = is_here || client == nullptr ? std::nullopt : find_elsewhere(id);
  if (!located) return false;
  const auto url = resources_.cluster->url_of(*located);
  const bool relays = resources_.relay != nullptr && !client->is_relayed;
  if (auto error = admission_.refuse_access(*client, located->number)) {
    reply.answer(*std::move(error));
  } else if (located->owner == resources_.cluster->name()) {
    reply.answer(not_recovered(id, "recovering"));
  } else if (!relays) {
    reply.answer(moved_to(id, url.value_or("")));
  } else if (!url || !can_relay(*located)) {
    reply.answer(not_recovered(id, "recovering"));
  } else {
    RelayedRequest::NoteResult note;
    if (request.method == "replay.open") note = note_replay_of(client->outbox->id());
    send_request(*client, reply, request, id, {located->owner, located->epoch}, std::move(note));
  }
  return true;
}

void SessionDirectory::send_request(const Client& client, PendingReply& reply,
                                    const RpcRequest& request, const SessionId& session,
                                    const RelayDoor::Owner& owner,
                                    RelayedRequest::NoteResult note) {
  VAT_CHECK(tables_.mutex.is_held());
  resources_.relay->open_request(session, owner, std::move(note))
      ->send(std::move(reply), entry_for(client, session, {}), request.method, request.params);
}

std::function<void(Json& result)> SessionDirectory::note_replay_of(ConnectionId creator) {
  return [this, creator](Json& result) {
    keep_ticket(creator, result);
    result.erase("ticket");
  };
}

void SessionDirectory::note_granted(ConnectionId id, const SessionId& session, const Grant& grant) {
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(id);
  if (client == nullptr) return;
  client->tickets.erase(session);
  client->relay_access[session] = grant;
}

void SessionDirectory::keep_ticket(ConnectionId creator, const RpcResult& created) {
  const auto* result = std::get_if<Json>(&created);
  if (resources_.relay == nullptr || result == nullptr || !result->contains("ticket")) return;
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(creator);
  if (client != nullptr) client->tickets[result->at("session")] = result->at("ticket");
}

bool SessionDirectory::watch(const std::shared_ptr<ClientOutbox>& viewer, const SessionId& id,
                             const Subscription& wanted) {
  const std::lock_guard lock(tables_.mutex);
  const auto* found = tables_.sessions.find(id);
  if (found == nullptr) return false;
  found->second->watch(viewer, wanted);
  return true;
}

void SessionDirectory::unwatch(const SessionId& id, std::shared_ptr<ClientOutbox> viewer) {
  const std::lock_guard lock(tables_.mutex);
  const auto* found = tables_.sessions.find(id);
  if (found != nullptr) found->second->unwatch(std::move(viewer));
}

std::optional<RelayDoor::Owner> SessionDirectory::present_owner(const SessionId& id) const {
  const auto located = find_elsewhere(id);
  if (!located) return {};
  const bool is_present = resources_.cluster->is_present(located->owner);
  return RelayDoor::Owner{is_present ? located->owner : "", located->epoch};
}

}  // namespace vat
