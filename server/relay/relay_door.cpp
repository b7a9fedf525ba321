#include "server/relay/relay_door.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {

RelayDoor::RelayDoor(Place place, NatsConnection& connection, ServerMetrics& metrics,
                     boost::asio::thread_pool& pool, const Clock& clock)
    : place_(std::move(place)),
      connection_(connection),
      metrics_(metrics),
      pool_(pool),
      clock_(clock),
      subject_("vat.relay." + place_.node + ".clients") {
  subscription_ = connection_.subscribe(
      subject_, [this](const NatsMessage& message) { receive(message.data); });
}

std::string RelayDoor::owner_subject(const std::string& node) {
  return "vat.relay." + node + ".owner";
}

std::string RelayDoor::next_link() {
  VAT_CHECK(mutex_.is_held());
  return place_.node + "." + place_.instance + "." + std::to_string(++links_opened_);
}

std::shared_ptr<RelayedClient> RelayDoor::open(std::shared_ptr<ClientOutbox> outbox,
                                               const std::string& session, const std::string& owner,
                                               std::uint64_t epoch) {
  const std::lock_guard lock(mutex_);
  std::erase_if(clients_, [](const auto& entry) { return entry.second.expired(); });
  const std::string link = next_link();
  auto client = std::make_shared<RelayedClient>(
      RelayedClient::Place{session, owner, epoch, place_.url, subject_},
      std::make_unique<RelayLine>(connection_, owner_subject(owner), link), std::move(outbox),
      RelayedClient::Links{[this, session, owner] { return feed(session, owner); },
                           [this, session, epoch] { note_move(session, epoch); }},
      clock_);
  clients_[link] = client;
  return client;
}

std::shared_ptr<RelayFeed> RelayDoor::feed(const std::string& session, const std::string& owner) {
  const std::lock_guard lock(mutex_);
  std::erase_if(feeds_, [](const auto& entry) { return entry.second.expired(); });
  auto known = feeds_[session].lock();
  if (known != nullptr && known->owner() == owner && !known->has_ended()) return known;
  const std::string link = next_link();
  const std::string subject = "vat.relay." + place_.node + ".feed." + std::to_string(links_opened_);
  auto feed = std::make_shared<RelayFeed>(
      RelayFeed::Place{session, owner, link, owner_subject(owner), subject}, connection_, metrics_,
      pool_, clock_);
  feed->start();
  feeds_[session] = feed;
  return feed;
}

void RelayDoor::note_move(const std::string& session, std::uint64_t epoch) {
  const std::lock_guard lock(mutex_);
  std::uint64_t& ended = moved_[session];
  ended = std::max(ended, epoch);
}

bool RelayDoor::has_moved(const std::string& session, std::uint64_t epoch) {
  const std::lock_guard lock(mutex_);
  const auto found = moved_.find(session);
  if (found == moved_.end()) return false;
  if (epoch <= found->second) return true;
  moved_.erase(found);  // the directory shows the next owner
  return false;
}

void RelayDoor::receive(const std::string& bytes) {
  auto message = read_relay_message(bytes);
  if (!message) return;
  std::shared_ptr<RelayedClient> client;
  {
    const std::lock_guard lock(mutex_);
    const auto found = clients_.find(message->link);
    if (found != clients_.end()) client = found->second.lock();
  }
  if (client == nullptr) return;
  try {
    client->receive(*std::move(message));
  } catch (const std::exception& error) {  // of another version of this program, for example
    log_error("relay: {}", error.what());
    client->fail();
  }
}

void RelayDoor::end_silent(const std::function<bool(const std::string&)>& is_present) {
  std::vector<std::shared_ptr<RelayedClient>> silent;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [link, weak] : clients_) {
      auto client = weak.lock();
      if (client != nullptr && !is_present(client->owner())) silent.push_back(std::move(client));
    }
  }
  for (const auto& client : silent) client->fail();
}

}  // namespace vat
