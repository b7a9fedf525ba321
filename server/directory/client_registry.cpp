#include "server/directory/client_registry.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/support/check.h"

namespace vat {

Client& ClientRegistry::add(std::shared_ptr<ClientOutbox> outbox) {
  VAT_CHECK(mutex_.is_held());
  const ConnectionId id = outbox->id();
  const auto [client, is_new] = clients_.try_emplace(id);
  VAT_CHECK(is_new);
  client->second.outbox = std::move(outbox);
  return client->second;
}

Client* ClientRegistry::find(ConnectionId id) {
  VAT_CHECK(mutex_.is_held());
  const auto client = clients_.find(id);
  return client == clients_.end() ? nullptr : &client->second;
}

const Client* ClientRegistry::find(ConnectionId id) const {
  VAT_CHECK(mutex_.is_held());
  const auto client = clients_.find(id);
  return client == clients_.end() ? nullptr : &client->second;
}

void ClientRegistry::remove(ConnectionId id) {
  VAT_CHECK(mutex_.is_held());
  const std::size_t removed = clients_.erase(id);
  VAT_CHECK(removed == 1);
}

std::size_t ClientRegistry::size() const {
  VAT_CHECK(mutex_.is_held());
  return clients_.size();
}

std::size_t ClientRegistry::count_in(SessionNumber session) const {
  VAT_CHECK(mutex_.is_held());
  return static_cast<std::size_t>(std::ranges::count_if(
      clients_, [&](const auto& entry) { return entry.second.session == session; }));
}

const std::map<ConnectionId, Client>& ClientRegistry::all() const {
  VAT_CHECK(mutex_.is_held());
  return clients_;
}

std::size_t ClientRegistry::queue_bytes() const {
  VAT_CHECK(mutex_.is_held());
  QueueMemory memory;
  for (const auto& [connection, client] : clients_) client.outbox->add_queue(memory);
  return memory.bytes();
}

std::size_t ClientRegistry::bound_queues(std::size_t maximum) const {
  VAT_CHECK(mutex_.is_held());
  QueueMemory all;
  std::vector<std::pair<std::size_t, ClientOutbox*>> queues;
  for (const auto& [connection, client] : clients_) {
    queues.emplace_back(client.outbox->add_queue(all), client.outbox.get());
  }
  if (all.bytes() <= maximum) return 0;
  std::ranges::sort(queues, {}, &std::pair<std::size_t, ClientOutbox*>::first);
  QueueMemory kept;
  std::size_t closed = 0;
  for (const auto& [share, outbox] : queues) {
    outbox->add_queue(kept);
    if (kept.bytes() <= maximum) continue;
    outbox->close_for_others();
    ++closed;
  }
  return closed;
}

void ClientRegistry::close_session(SessionNumber session, const std::string& event,
                                   const std::string& relayed_event) {
  VAT_CHECK(mutex_.is_held());
  for (auto& [connection, client] : clients_) {
    if (client.session != session) continue;
    client.session = 0;
    client.outbox->leave();
    client.outbox->send(client.is_relayed ? relayed_event : event);  // the last of the session
  }
  VAT_CHECK(count_in(session) == 0);
}

}  // namespace vat
