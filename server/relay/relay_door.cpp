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
  for (const auto& end : all_ends()) end->fail();  // ends that wait own themselves
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

RelayPlace RelayDoor::place_of(const std::string& link, const std::string& session,
                               const Owner& owner) const {
  return {session, owner.node, owner.epoch, place_.url, client_subject(link)};
}

std::unique_ptr<RelayLine> RelayDoor::make_line(const std::string& link, const Owner& owner) const {
  return std::make_unique<RelayLine>(connection_, owner_subject(owner.node), link);
}

std::shared_ptr<RelayedClient> RelayDoor::open(std::shared_ptr<ClientOutbox> outbox,
                                               const std::string& session, const Owner& owner) {
  const std::lock_guard lock(mutex_);
  const std::string link = next_link();
  auto client = std::make_shared<RelayedClient>(
      place_of(link, session, owner), make_line(link, owner), std::move(outbox),
      RelayedClient::Links{[this, session, owner] { return feed(session, owner); },
                           [this, session, owner] { note_move(session, owner.epoch); }},
      clock_);
  ends_[link] = client;
  return client;
}

std::shared_ptr<RelayedRequest> RelayDoor::open_request(const std::string& session,
                                                        const Owner& owner,
                                                        RelayedRequest::NoteResult note_result) {
  const std::lock_guard lock(mutex_);
  const std::string link = next_link();
  auto request = std::make_shared<RelayedRequest>(
      place_of(link, session, owner), make_line(link, owner),
      RelayedRequest::Links{[this, session, owner] { note_move(session, owner.epoch); },
                            std::move(note_result)},
      clock_);
  ends_[link] = request;
  return request;
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
  std::shared_ptr<RelayEnd> end;
  {
    const std::lock_guard lock(mutex_);
    const auto found = ends_.find(message->link);
    if (found != ends_.end()) end = found->second.lock();
  }
  if (end == nullptr) return;
  try {
    end->receive(*std::move(message));
  } catch (const std::exception& error) {  // of another version of this program, for example
    log_error("relay: {}", error.what());
    end->fail();
  }
}

std::vector<std::shared_ptr<RelayEnd>> RelayDoor::all_ends() {
  const std::lock_guard lock(mutex_);
  std::vector<std::shared_ptr<RelayEnd>> all;
  for (const auto& [link, weak] : ends_) {
    if (auto end = weak.lock()) all.push_back(std::move(end));
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
    std::erase_if(ends_, [](const auto& entry) { return entry.second.expired(); });
    std::erase_if(feeds_, [](const auto& entry) { return entry.second.feed.expired(); });
    std::erase_if(moved_, [&](const auto& entry) {
      const auto owner = owner_of(entry.first);
      return !owner || owner->epoch > entry.second;
    });
  }
  for (const auto& end : all_ends()) {
    const RelayPlace& place = end->place();
    const auto owner = owner_of(place.session);
    if (owner && (owner->node != place.owner || owner->epoch != place.epoch)) {
      end->owner_changed();
    } else {
      end->look();
    }
  }
  for (const auto& feed : all_feeds()) feed->look(patience);
}

}  // namespace vat
