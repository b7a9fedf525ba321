#include "server/relay/relay_door.h"

#include <algorithm>
#include <exception>
#include <mutex>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::chrono::seconds kLookInterval(1);

}  // namespace

RelayDoor::RelayDoor(Place place, NatsConnection& connection, ServerMetrics& metrics,
                     boost::asio::thread_pool& pool, const Clock& clock)
    : place_(std::move(place)),
      connection_(connection),
      metrics_(metrics),
      pool_(pool),
      clock_(clock) {
  subscription_ = connection_.subscribe(
      client_subject(place_.node), [this](const NatsMessage& message) { receive(message.data); });
}

RelayDoor::~RelayDoor() {
  for (const auto& client : all_clients()) client->fail();  // clients that wait own themselves
}

std::string RelayDoor::owner_subject(const std::string& node) {
  return "vat.relay." + node + ".owner";
}

std::string RelayDoor::client_subject(const std::string& link) {
  return "vat.relay." + link.substr(0, link.find('.')) + ".clients";
}

std::string RelayDoor::next_link() {
  VAT_CHECK(mutex_.is_held());
  return place_.node + "." + place_.instance + "." + std::to_string(++links_opened_);
}

std::shared_ptr<RelayedClient> RelayDoor::open(std::shared_ptr<ClientOutbox> outbox,
                                               const std::string& session, const Owner& owner) {
  const std::lock_guard lock(mutex_);
  const std::string link = next_link();
  auto client = std::make_shared<RelayedClient>(
      RelayedClient::Place{session, owner.node, owner.epoch, place_.url, client_subject(link)},
      std::make_unique<RelayLine>(connection_, owner_subject(owner.node), link), std::move(outbox),
      RelayedClient::Links{[this, session, owner] { return feed(session, owner); },
                           [this, session, owner] { note_move(session, owner.epoch); }},
      clock_);
  clients_[link] = client;
  return client;
}

std::shared_ptr<RelayFeed> RelayDoor::feed(const std::string& session, const Owner& owner) {
  const std::lock_guard lock(mutex_);
  Feed& entry = feeds_[session];
  if (auto known = entry.feed.lock(); known != nullptr && known->place().owner == owner.node &&
                                      known->place().epoch == owner.epoch) {
    return known;
  }
  const std::string link = next_link();
  const std::string subject = "vat.relay." + place_.node + ".feed." + std::to_string(links_opened_);
  auto feed = std::make_shared<RelayFeed>(
      RelayFeed::Place{session, owner.node, owner.epoch, link, owner_subject(owner.node), subject},
      connection_, metrics_, pool_, clock_);
  entry.feed = feed;
  entry.subscription =
      connection_.subscribe(subject, [weak = entry.feed](const NatsMessage& message) {
        if (const auto known = weak.lock()) known->receive(message.data);
      });
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
  return found != moved_.end() && epoch <= found->second;
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

std::vector<std::shared_ptr<RelayedClient>> RelayDoor::all_clients() {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<RelayedClient>> all;
  for (const auto& [link, weak] : clients_) {
    if (auto client = weak.lock()) all.push_back(std::move(client));
  }
  return all;
}

std::vector<std::shared_ptr<RelayFeed>> RelayDoor::all_feeds() {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<RelayFeed>> all;
  for (const auto& [session, entry] : feeds_) {
    if (auto feed = entry.feed.lock()) all.push_back(std::move(feed));
  }
  return all;
}

void RelayDoor::look(const std::function<std::optional<Owner>(const std::string&)>& owner_of,
                     std::chrono::seconds patience) {
  {
    const std::lock_guard lock(mutex_);
    if (clock_.now() - looked_ < kLookInterval) return;
    looked_ = clock_.now();
    std::erase_if(clients_, [](const auto& entry) { return entry.second.expired(); });
    std::erase_if(feeds_, [](const auto& entry) { return entry.second.feed.expired(); });
    std::erase_if(moved_, [&](const auto& entry) {
      const auto owner = owner_of(entry.first);
      return !owner || owner->epoch > entry.second;
    });
  }
  for (const auto& client : all_clients()) {
    const RelayedClient::Place& place = client->place();
    const auto owner = owner_of(place.session);
    if (owner && (owner->node != place.owner || owner->epoch != place.epoch)) {
      client->fail();
    } else {
      client->look();
    }
  }
  for (const auto& feed : all_feeds()) feed->look(patience);
}

}  // namespace vat
