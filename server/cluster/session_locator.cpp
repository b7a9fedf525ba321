#include "server/cluster/session_locator.h"

#include <algorithm>
#include <charconv>
#include <system_error>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/support/hex.h"
#include "server/support/log.h"

namespace vat {
namespace {

/// Returns the number of a session in a value of the bucket. Throws NatsError.
std::uint64_t stored_number_of(const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = text.data() + text.size();
  const auto [stop, code] = std::from_chars(text.data(), end, number);
  if (code != std::errc() || stop != end) {
    throw NatsError(NatsError::Kind::refused, "the directory contains '" + text + "'");
  }
  return number;
}

constexpr std::string_view kSessionKey = "session.";
constexpr const char* kCounterKey = "last_number";
constexpr int kAttempts = 100;  // of concurrent creations
constexpr std::size_t kMaxRemoved = 10'000;

std::string session_key(std::uint64_t number) {
  return std::string(kSessionKey) + std::to_string(number);
}

std::string key_of_name(const std::string& name) {
  return "name." + to_hex(name);
}

std::optional<std::uint64_t> number_in_key(std::string_view key) {
  if (!key.starts_with(kSessionKey)) return {};
  key.remove_prefix(kSessionKey.size());
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(key.data(), key.data() + key.size(), number);
  if (error != std::errc() || end != key.data() + key.size()) return {};
  return number;
}

std::string write_located(const LocatedSession& session) {
  return Json{{"name", session.name},
              {"owner", session.owner},
              {"successor", session.successor},
              {"epoch", session.epoch},
              {"instruction_set", session.instruction_set},
              {"created", session.created}}
      .dump();
}

std::optional<LocatedSession> read_located(const Bucket::Entry& entry) {
  const auto number = number_in_key(entry.key);
  if (!number) return {};
  const Json json = Json::parse(entry.value, nullptr, false);
  try {
    return LocatedSession{*number,
                          json.at("name"),
                          json.at("owner"),
                          json.at("successor"),
                          json.at("epoch"),
                          json.at("instruction_set"),
                          json.at("created"),
                          entry.revision};
  } catch (const Json::exception& error) {
    log_error("the entry {} of the cluster's directory is invalid: {}", entry.key, error.what());
    return {};
  }
}

}  // namespace

SessionLocator::SessionLocator(NatsConnection& connection, std::uint64_t kept_changes)
    : bucket_(connection, "vat-sessions", std::chrono::milliseconds(0)),
      kept_changes_(kept_changes) {}

void SessionLocator::watch(std::function<void(const LocatedSession&)> changed) {
  changed_ = std::move(changed);
  watch_ = bucket_.watch([this](const Bucket::Entry& entry) { follow(entry); });
}

void SessionLocator::follow(const Bucket::Entry& entry) {
  if (entry.is_removed) {
    if (const auto number = number_in_key(entry.key)) {
      LocatedSession session;
      session.number = *number;
      session.revision = entry.revision;
      note(session, true);
    }
  } else if (const auto session = read_located(entry)) {
    note(*session, false);
  }
  const std::lock_guard lock(mutex_);
  if (entry.revision == complete_to_ + 1) complete_to_ = entry.revision;
}

void SessionLocator::erase(std::map<std::uint64_t, LocatedSession>::iterator session) {
  const auto owner = by_owner_.find(session->second.owner);
  owner->second.erase(session->first);
  if (owner->second.empty()) by_owner_.erase(owner);
  sessions_.erase(session);
}

void SessionLocator::note(const LocatedSession& session, bool is_removed) {
  {
    const std::lock_guard lock(mutex_);
    const auto known = sessions_.find(session.number);
    if (known != sessions_.end() && known->second.revision >= session.revision) return;
    const auto removed = removed_.find(session.number);
    if (removed != removed_.end() && removed->second >= session.revision) return;
    if (known != sessions_.end()) erase(known);
    if (is_removed) {
      removed_[session.number] = session.revision;
      if (removed_.size() > kMaxRemoved) removed_.erase(removed_.begin());
    } else {
      sessions_[session.number] = session;
      by_owner_[session.owner].insert(session.number);
    }
  }
  if (changed_) changed_(session);
}

void SessionLocator::refresh() {
  const std::uint64_t last = bucket_.last_revision();
  std::uint64_t known = 0;
  {
    const std::lock_guard lock(mutex_);
    known = complete_to_;
  }
  drop_old_marks(last);
  if (last == known) return;
  // At the start, of a new bucket, or if marks of missed removals may be dropped during the
  // reading.
  if (known == 0 || last < known || last - known > kept_changes_ / 2) return read_all(last);
  std::uint64_t reached = last;
  for (const Bucket::Entry& entry : bucket_.changes_since(known)) {
    follow(entry);
    reached = std::max(reached, entry.revision);
  }
  const std::lock_guard lock(mutex_);
  complete_to_ = std::max(complete_to_, reached);
}

void SessionLocator::read_all(std::uint64_t last_revision) {
  std::map<std::uint64_t, LocatedSession> before;
  {
    const std::lock_guard lock(mutex_);
    before = sessions_;
  }
  for (const Bucket::Entry& entry : bucket_.changes_since(0)) {
    if (entry.is_removed) {
      const std::lock_guard lock(mutex_);
      marks_.emplace_back(entry.key, entry.revision);
    } else if (const auto session = read_located(entry)) {
      before.erase(session->number);
      note(*session, false);
    }
  }
  for (auto& [number, session] : before) {
    if (read(number)) continue;
    ++session.revision;  // of the removal, which was not seen
    note(session, true);
  }
  const std::lock_guard lock(mutex_);
  complete_to_ = last_revision;
}

void SessionLocator::remove_key(const std::string& key, std::uint64_t revision) {
  const std::uint64_t mark = bucket_.remove(key, revision);
  const std::lock_guard lock(mutex_);
  marks_.emplace_back(key, mark);
}

void SessionLocator::drop_old_marks(std::uint64_t last_revision) {
  for (;;) {
    std::pair<std::string, std::uint64_t> mark;
    {
      const std::lock_guard lock(mutex_);
      if (marks_.empty() || marks_.front().second + kept_changes_ > last_revision) return;
      mark = std::move(marks_.front());
      marks_.pop_front();
    }
    bucket_.drop_mark(mark.first, mark.second);
  }
}

std::uint64_t SessionLocator::next_number() {
  for (int i = 0; i < kAttempts; ++i) {
    try {
      const auto last = bucket_.get(kCounterKey);
      const std::uint64_t next = last ? stored_number_of(last->value) + 1 : 1;
      if (last) {
        bucket_.put(kCounterKey, std::to_string(next), last->revision);
      } else {
        bucket_.create(kCounterKey, std::to_string(next));
      }
      return next;
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict) throw;
    }
  }
  throw NatsError(NatsError::Kind::unreachable, "too many sessions are created at once");
}

void SessionLocator::take_name(const std::string& name, std::uint64_t number) {
  if (name.empty()) return;
  const std::string value = std::to_string(number);
  try {
    bucket_.create(key_of_name(name), value);
  } catch (const NatsError& error) {
    if (error.kind() != NatsError::Kind::conflict) throw;
    // A node that ended during a creation or removal may have left the name without a session.
    const auto entry = bucket_.get(key_of_name(name));
    if (entry && entry->value == value) return;
    if (entry && read(stored_number_of(entry->value))) throw NameInUse(name);
    try {
      bucket_.put(key_of_name(name), value, entry ? entry->revision : Bucket::kNone);
    } catch (const NatsError& later) {
      if (later.kind() == NatsError::Kind::conflict) throw NameInUse(name);
      throw;
    }
  }
}

void SessionLocator::check_name(const LocatedSession& session) {
  if (session.name.empty()) return;
  const auto entry = bucket_.get(key_of_name(session.name));
  if (entry && entry->value == std::to_string(session.number)) return;
  remove(session);
  throw NameInUse(session.name);
}

void SessionLocator::free_name(const std::string& name, std::uint64_t number) {
  if (name.empty()) return;
  const auto entry = bucket_.get(key_of_name(name));
  if (entry && entry->value == std::to_string(number)) remove_key(entry->key, entry->revision);
}

LocatedSession SessionLocator::create(LocatedSession session) {
  take_name(session.name, session.number);
  session.epoch = 1;
  session.revision = Bucket::kNone;
  session = put(std::move(session));
  check_name(session);  // until now, another node could take the name
  return session;
}

LocatedSession SessionLocator::put(LocatedSession session) {
  session.revision =
      bucket_.put(session_key(session.number), write_located(session), session.revision);
  note(session, false);
  return session;
}

LocatedSession SessionLocator::take(const LocatedSession& session, const std::string& node) {
  LocatedSession taken = session;
  taken.owner = node;
  taken.successor.clear();
  ++taken.epoch;
  return put(std::move(taken));
}

LocatedSession SessionLocator::renew(const LocatedSession& session) {
  return put(session);
}

LocatedSession SessionLocator::release(const LocatedSession& session,
                                       const std::string& successor) {
  LocatedSession released = session;
  released.owner.clear();
  released.successor = successor;
  return put(std::move(released));
}

LocatedSession SessionLocator::rename(const LocatedSession& session, const std::string& name) {
  if (session.name == name) return session;
  take_name(name, session.number);
  LocatedSession renamed = session;
  renamed.name = name;
  renamed = put(std::move(renamed));
  free_name(session.name, session.number);
  return renamed;
}

void SessionLocator::remove(const LocatedSession& session) {
  remove_key(session_key(session.number), session.revision);
  free_name(session.name, session.number);
}

std::optional<LocatedSession> SessionLocator::read(std::uint64_t number) {
  const auto entry = bucket_.get(session_key(number));
  if (!entry) return {};
  return read_located(*entry);
}

std::optional<LocatedSession> SessionLocator::find(std::uint64_t number) const {
  const std::lock_guard lock(mutex_);
  const auto found = sessions_.find(number);
  if (found == sessions_.end()) return {};
  return found->second;
}

std::vector<LocatedSession> SessionLocator::all() const {
  const std::lock_guard lock(mutex_);
  std::vector<LocatedSession> all;
  for (const auto& [number, session] : sessions_) all.push_back(session);
  return all;
}

std::vector<std::string> SessionLocator::owners() const {
  const std::lock_guard lock(mutex_);
  std::vector<std::string> owners;
  for (const auto& [owner, numbers] : by_owner_) owners.push_back(owner);
  return owners;
}

std::vector<LocatedSession> SessionLocator::sessions_of(const std::string& owner) const {
  const std::lock_guard lock(mutex_);
  std::vector<LocatedSession> sessions;
  const auto found = by_owner_.find(owner);
  if (found == by_owner_.end()) return sessions;
  for (const std::uint64_t number : found->second) sessions.push_back(sessions_.at(number));
  return sessions;
}

}  // namespace vat
