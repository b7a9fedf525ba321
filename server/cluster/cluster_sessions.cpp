// Sessions of a node: new, taken, lost and moved ones.

#include <algorithm>
#include <boost/asio/post.hpp>
#include <charconv>
#include <condition_variable>
#include <utility>

#include "core/support/check.h"
#include "server/cluster/cluster_node.h"
#include "server/cluster/session_reader.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr int kUpdateAttempts = 10;

std::string id_of_session(std::uint64_t session) {
  return "s" + std::to_string(session);
}

std::optional<std::uint64_t> session_of_id(std::string_view id) {
  std::uint64_t number = 0;
  const char* const end = id.data() + id.size();
  if (!id.starts_with('s')) return {};
  const auto [stop, error] = std::from_chars(id.data() + 1, end, number);
  if (error != std::errc() || stop != end) return {};
  return number;
}

}  // namespace

std::shared_ptr<SessionStream> ClusterNode::make_stream(SessionStream::Place place) {
  const std::uint64_t number = place.session;
  return std::make_shared<SessionStream>(
      streams_, lease_, clock_, threads_.get_executor(), std::move(place),
      [this, number] { post([this, number] { lose(number); }); },
      [this, number](const std::string& name) {
        update(number, [&](const LocatedSession& entry) { return locator_.rename(entry, name); });
      });
}

std::uint64_t ClusterNode::add_session(const std::string& name, const std::string& instruction_set,
                                       const std::string& settings, const LogEntry& first) {
  LocatedSession entry;
  entry.number = locator_.next_number();
  entry.name = name;
  entry.owner = settings_.node;
  entry.instruction_set = instruction_set;
  entry.created = clock_.wall_time();
  SessionStream::Place place;
  place.session = entry.number;
  place.epoch = 1;
  place.last_entry = first.sequence;
  place.name = name;
  place.settings = settings;
  reserve(entry.number);
  try {
    entry = locator_.create(entry);
    const std::string message =
        write_records({EntriesRecord{{first}}, SettingsRecord{name, settings}});
    std::size_t part = 0;
    for (const LogPart& one : split_message(message)) {
      place.last_messages[0] =
          streams_.logs[0].append(log_subject(entry.number, 0), one.bytes, place.last_messages[0],
                                  {{kEpochHeader, "1"},
                                   {kWriteHeader, "1.0." + std::to_string(part++)},
                                   {kPartHeader, one.header}});
    }
  } catch (const NatsError&) {
    if (entry.revision > 0) locator_.remove(entry);
    unreserve(entry.number);
    throw;
  }
  {
    const std::lock_guard lock(mutex_);
    hosted_[entry.number] = {make_stream(std::move(place)), entry};
  }
  unreserve(entry.number);
  return entry.number;
}

void ClusterNode::remove_session(std::uint64_t session,
                                 std::function<void(std::optional<StorageError::Kind>)> done) {
  boost::asio::post(threads_, [this, session, done = std::move(done)] {
    try {
      update(session, [this](const LocatedSession& entry) {
        locator_.remove(entry);
        return entry;
      });
      forget(session);
      remove_messages(streams_, session);
      remove_saved(session);
    } catch (const NatsError& error) {
      log_warning("session {} is not removed: {}", id_of_session(session), error.what());
      if (find_hosted(session)) return done(StorageError::Kind::unreachable);
    }
    done({});
  });
}

bool ClusterNode::has_session(const std::string& id) {
  const auto number = session_of_id(id);
  return number && (locator_.find(*number) || locator_.read(*number));
}

void ClusterNode::remove_saved(std::uint64_t session) {
  try {
    saved_states_.remove_session(id_of_session(session));
  } catch (const StorageError& error) {  // a write that needs their space removes them
    log_warning("the saved states of session {} are not removed: {}", id_of_session(session),
                error.what());
  }
}

bool ClusterNode::forget(std::uint64_t session) {
  std::shared_ptr<SessionStream> stream;
  {
    const std::lock_guard lock(mutex_);
    const auto found = hosted_.extract(session);
    if (!found) return false;
    stream = found.mapped().stream;
  }
  stream->end();
  return true;
}

LocatedSession ClusterNode::update(
    std::uint64_t session, const std::function<LocatedSession(const LocatedSession&)>& change) {
  for (int attempt = 1;; ++attempt) {
    const auto hosted = find_hosted(session);
    if (!hosted) throw NatsError(NatsError::Kind::conflict, "the session has moved");
    try {
      const LocatedSession changed = change(hosted->entry);
      const std::lock_guard lock(mutex_);
      const auto found = hosted_.find(session);
      if (found != hosted_.end()) found->second.entry = changed;
      return changed;
    } catch (const NameInUse&) {
      throw;
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict || attempt == kUpdateAttempts) throw;
    }
    const auto current = locator_.read(session);
    if (!current || current->owner != name() || current->epoch != hosted->entry.epoch) {
      throw NatsError(NatsError::Kind::conflict, "the session has another owner");
    }
    const std::lock_guard lock(mutex_);
    const auto found = hosted_.find(session);
    if (found != hosted_.end()) found->second.entry = *current;
  }
}

void ClusterNode::check_sessions(Time sent) {
  std::vector<std::uint64_t> numbers;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, hosted] : hosted_) numbers.push_back(number);
  }
  for (const std::uint64_t number : numbers) {
    try {
      update(number, [this](const LocatedSession& entry) { return locator_.renew(entry); });
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict) {
        checking_ = false;  // the next renewal tries again
        return;
      }
      lose(number);
    }
  }
  checking_ = false;
  if (lease_.reopen(sent)) log_info("the node {} may serve its sessions", name());
}

bool ClusterNode::is_silent(const std::string& node) {
  if (spare_bucket_.get(node)) return false;  // an entry ends soon after its renewal
  const auto entry = node_bucket_.get(node);
  if (!entry) return true;
  if (entry->revision == nodes_.revision_of(node)) {
    return nodes_.silence_of(node) >= Lease::kOthersTime;
  }
  if (auto info = read_node(entry->key, entry->value))
    nodes_.note(*std::move(info), entry->revision);
  return false;
}

void ClusterNode::take(std::uint64_t session) {
  const auto finish = [&](bool has_failed) {
    {
      const std::lock_guard lock(mutex_);
      orphans_.erase(session);
      if (has_failed) failed_[session] = clock_.now();
    }
    unreserve(session);
  };
  try {
    const auto before = locator_.read(session);
    const bool is_other = before && !before->owner.empty() && before->owner != name();
    // Another node may have taken it, or released it to another one, since it was looked at.
    if (!before || !is_wanted(*before)) return finish(false);
    if (is_other && !is_silent(before->owner)) return finish(false);
    const LocatedSession entry = locator_.take(*before, name());
    const SessionImage image = take_image(streams_, entry);
    store_image(storage_, image);
    SessionStream::Place place;
    place.session = session;
    place.epoch = entry.epoch;
    place.last_messages = image.last_messages;
    place.last_entry = image.entries.empty() ? 0 : image.entries.back().sequence;
    if (image.state) place.last_entry = std::max(place.last_entry, image.state->sequence);
    place.name = image.stored.name;
    place.settings = image.stored.settings;
    place.manifest = image.manifest;
    place.manifest_message = image.manifest_message;
    {
      const std::lock_guard lock(mutex_);
      hosted_[session] = {make_stream(std::move(place)), entry};
    }
    log_info("session {} is taken from {}, epoch {}", id_of_session(session),
             before->owner.empty() ? "its previous node" : before->owner, entry.epoch);
    host_->start_taken(image.stored);
    finish(false);
  } catch (const NatsError& error) {
    log_warning("session {} is not taken: {}", id_of_session(session), error.what());
    finish(false);
  } catch (const std::exception& error) {
    log_error("session {} cannot be taken: {}", id_of_session(session), error.what());
    finish(true);
  }
}

void ClusterNode::lose(std::uint64_t session) {
  reserve(session);  // the node may not take it again before its end
  if (!forget(session)) return unreserve(session);
  const auto entry = locator_.find(session);
  log_warning("session {} has another owner{}", id_of_session(session),
              entry ? ": " + entry->owner : "");
  end_lost(session, entry ? url_of(*entry).value_or("") : "");
}

void ClusterNode::end_lost(std::uint64_t session, const std::string& url) {
  host_->end_lost(session, url, [this, session] { unreserve(session); });
}

void ClusterNode::reserve(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  reserved_.insert(session);
}

void ClusterNode::unreserve(std::uint64_t session) {
  const std::lock_guard lock(mutex_);
  const auto found = reserved_.find(session);
  VAT_CHECK(found != reserved_.end());
  reserved_.erase(found);
}

std::optional<ClusterNode::MoveRefusal> ClusterNode::move(std::uint64_t session,
                                                          const std::string& node, Moved done) {
  const auto info = nodes_.find(node);
  {
    const std::lock_guard lock(mutex_);
    const auto hosted = hosted_.find(session);
    if (hosted == hosted_.end()) return MoveRefusal::not_owned;
    if (node == name() || !info || !info->accepts ||
        !nodes_.is_seen_within(node, Lease::kHolderTime)) {
      return MoveRefusal::not_present;
    }
    if (!has_instructions(*info, hosted->second.entry.instruction_set)) {
      return MoveRefusal::lacks_instructions;
    }
    const auto [move, is_new] = moves_.try_emplace(session, Move{node, {}});
    if (!is_new && move->second.successor != node) return MoveRefusal::is_moving;
    move->second.waiting.push_back(std::move(done));
    if (!is_new) return {};
    reserved_.insert(session);
  }
  const bool has_begun = host_->stop_for_move(
      session, [this, session, node] { post([this, session, node] { release(session, node); }); });
  if (!has_begun) {
    unreserve(session);
    end_move(session, {});
  }
  return {};
}

void ClusterNode::release(std::uint64_t session, const std::string& successor) {
  std::optional<std::string> url;
  try {
    update(session,
           [&](const LocatedSession& entry) { return locator_.release(entry, successor); });
    const auto node = nodes_.find(successor);
    url = node ? node->url : std::string();
    log_info("session {} is handed over to {}", id_of_session(session), successor);
  } catch (const NatsError& error) {
    log_warning("session {} is not released: {}", id_of_session(session), error.what());
  }
  // Without a release, this node takes the session again from its last state.
  if (forget(session)) {
    end_lost(session, url.value_or(""));
  } else {
    unreserve(session);  // it was lost during the hand-over, which has ended it
  }
  end_move(session, url);
}

void ClusterNode::end_move(std::uint64_t session, const std::optional<std::string>& url) {
  std::vector<Moved> waiting;
  {
    const std::lock_guard lock(mutex_);
    auto found = moves_.extract(session);
    VAT_CHECK(!found.empty());
    waiting = std::move(found.mapped().waiting);
  }
  for (const Moved& done : waiting) done(url);
}

bool ClusterNode::wait_for_move(std::uint64_t session, const Moved& done) {
  const std::lock_guard lock(mutex_);
  const auto found = moves_.find(session);
  if (found == moves_.end()) return false;
  found->second.waiting.push_back(done);
  return true;
}

void ClusterNode::drain(std::chrono::milliseconds time) {
  draining_ = true;
  struct Left {
    std::mutex mutex;
    std::condition_variable changed;
    std::size_t count = 0;
  };
  const auto left = std::make_shared<Left>();
  const Moved end = [left](const std::optional<std::string>&) {
    const std::lock_guard lock(left->mutex);
    --left->count;
    left->changed.notify_all();
  };
  std::map<std::uint64_t, std::string> sessions;  // with their instruction sets
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, hosted] : hosted_) sessions[number] = hosted.entry.instruction_set;
  }
  for (const auto& [number, instruction_set] : sessions) {
    std::vector<std::string> names;
    for (const NodeInfo& node : nodes_.seen_within(Lease::kHolderTime)) {
      const bool can_take = node.accepts && has_instructions(node, instruction_set);
      if (can_take && node.name != name()) names.push_back(node.name);
    }
    names = rank_nodes(number, std::move(names));
    {
      const std::lock_guard lock(left->mutex);
      ++left->count;
    }
    const bool waits =
        wait_for_move(number, end) || (!names.empty() && !move(number, names.front(), end));
    if (!waits) end({});
  }
  std::unique_lock lock(left->mutex);
  left->changed.wait_for(lock, time, [&] { return left->count == 0; });
}

}  // namespace vat
