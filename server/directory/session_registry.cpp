#include "server/directory/session_registry.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "core/support/check.h"

namespace vat {

SessionNumber SessionRegistry::next_number() {
  VAT_CHECK(mutex_.is_held());
  VAT_CHECK(last_number_ + 1 < kFirstReplay);
  return ++last_number_;
}

SessionNumber SessionRegistry::next_replay_number() {
  VAT_CHECK(mutex_.is_held());
  return ++last_replay_;
}

void SessionRegistry::add(SessionNumber number, std::shared_ptr<Session> session,
                          AddressCounts::Place place) {
  VAT_CHECK(mutex_.is_held());
  VAT_CHECK(session != nullptr && !absent_.contains(number));
  const bool is_new = running_.emplace(number, std::move(session)).second;
  VAT_CHECK(is_new);
  places_.emplace(number, std::move(place));
}

void SessionRegistry::remove(SessionNumber number) {
  VAT_CHECK(mutex_.is_held());
  places_.erase(number);
  const std::size_t removed = running_.erase(number);
  VAT_CHECK(removed == 1);
}

bool SessionRegistry::is_from(SessionNumber number, const std::string& address) const {
  VAT_CHECK(mutex_.is_held());
  const auto place = places_.find(number);
  return place != places_.end() && place->second != nullptr && place->second->address == address;
}

const SessionRegistry::Running::value_type* SessionRegistry::find(const SessionId& id) const {
  VAT_CHECK(mutex_.is_held());
  const auto found =
      std::ranges::find_if(running_, [&](const auto& entry) { return to_id(entry.first) == id; });
  return found == running_.end() ? nullptr : &*found;
}

const SessionRegistry::Running::value_type* SessionRegistry::first() const {
  VAT_CHECK(mutex_.is_held());
  return running_.empty() ? nullptr : &*running_.begin();
}

Session& SessionRegistry::at(SessionNumber number) const {
  VAT_CHECK(mutex_.is_held());
  const auto found = running_.find(number);
  VAT_CHECK(found != running_.end());
  return *found->second;
}

const SessionRegistry::Running& SessionRegistry::running() const {
  VAT_CHECK(mutex_.is_held());
  return running_;
}

std::size_t SessionRegistry::replay_count() const {
  VAT_CHECK(mutex_.is_held());
  return static_cast<std::size_t>(
      std::distance(running_.lower_bound(kFirstReplay), running_.end()));
}

std::uint64_t SessionRegistry::add_absent(SessionNumber number, const std::string& name) {
  VAT_CHECK(mutex_.is_held());
  VAT_CHECK(number < kFirstReplay && !running_.contains(number));
  AbsentSession& absent = absent_[number];
  absent.name = name;
  absent.recovery = ++last_recovery_;
  return absent.recovery;
}

AbsentSession* SessionRegistry::find_recovering(SessionNumber number, std::uint64_t recovery) {
  VAT_CHECK(mutex_.is_held());
  const auto found = absent_.find(number);
  return found == absent_.end() || found->second.recovery != recovery ? nullptr : &found->second;
}

void SessionRegistry::remove_absent(SessionNumber number) {
  VAT_CHECK(mutex_.is_held());
  const std::size_t removed = absent_.erase(number);
  VAT_CHECK(removed == 1);
}

SessionRegistry::Absent::value_type* SessionRegistry::find_absent(
    const std::optional<SessionId>& id) {
  VAT_CHECK(mutex_.is_held());
  if (id) {
    const auto found =
        std::ranges::find_if(absent_, [&](const auto& entry) { return to_id(entry.first) == *id; });
    return found == absent_.end() ? nullptr : &*found;
  }
  const auto first =
      std::ranges::find_if(absent_, [](const auto& entry) { return !entry.second.is_lost; });
  if (first == absent_.end()) return nullptr;
  const bool is_first = running_.empty() || first->first < running_.begin()->first;
  return is_first ? &*first : nullptr;
}

AbsentSession& SessionRegistry::absent_at(SessionNumber number) {
  VAT_CHECK(mutex_.is_held());
  const auto found = absent_.find(number);
  VAT_CHECK(found != absent_.end());
  return found->second;
}

const SessionRegistry::Absent& SessionRegistry::absent() const {
  VAT_CHECK(mutex_.is_held());
  return absent_;
}

bool SessionRegistry::is_recovering() const {
  VAT_CHECK(mutex_.is_held());
  return std::ranges::any_of(absent_, [](const auto& entry) { return !entry.second.is_lost; });
}

std::size_t SessionRegistry::size() const {
  VAT_CHECK(mutex_.is_held());
  return running_.size() + absent_.size();
}

}  // namespace vat
