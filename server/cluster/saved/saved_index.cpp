#include "server/cluster/saved/saved_index.h"

#include <algorithm>
#include <chrono>

#include "server/support/log.h"

namespace vat {
namespace {

constexpr int kChangeAttempts = 100;  // of concurrent changes

}  // namespace

SavedIndex::SavedIndex(NatsConnection& connection, std::uint64_t kept_changes)
    : connection_(connection),
      kept_changes_(kept_changes),
      bucket_(connection, "vat-saved", std::chrono::milliseconds(0)) {}

void SavedIndex::read(const std::function<void(const SavedEntries&)>& use) {
  const std::lock_guard lock(mutex_);
  refresh();
  use(entries_);
}

void SavedIndex::change(const std::function<std::optional<Change>(const SavedEntries&)>& choose) {
  const std::lock_guard lock(mutex_);
  for (int attempt = 1;; ++attempt) {
    refresh();
    const std::optional<Change> wanted = choose(entries_);
    if (!wanted) return;
    try {
      return make(*wanted);
    } catch (const NatsError& error) {
      if (error.kind() != NatsError::Kind::conflict || attempt == kChangeAttempts) throw;
    }
  }
}

void SavedIndex::make(const Change& change) {
  if (change.value) {
    revision_ = bucket_.put_after(change.key, change.value->dump(), revision_);
    entries_[change.key] = *change.value;
  } else {
    revision_ = bucket_.remove_after(change.key, revision_);
    entries_.erase(change.key);
    marks_.emplace_back(change.key, revision_);
  }
  drop_old_marks();
}

void SavedIndex::refresh() {
  if (!connection_.is_connected()) {
    throw NatsError(NatsError::Kind::disconnected, "there is no connection to NATS");
  }
  const std::uint64_t last = bucket_.last_revision();
  if (last == revision_) return;
  // At the start, of a new bucket, or if marks of missed removals may have been dropped.
  const bool is_whole = revision_ == 0 || last < revision_ || last - revision_ > kept_changes_ / 2;
  const std::vector<Bucket::Entry> changes = bucket_.changes_since(is_whole ? 0 : revision_);
  if (is_whole) {
    entries_.clear();
    marks_.clear();
  }
  for (const Bucket::Entry& entry : changes) note(entry, is_whole);
  revision_ = changes.empty() ? last : std::max(last, changes.back().revision);
}

void SavedIndex::note(const Bucket::Entry& entry, bool keeps_mark) {
  if (entry.is_removed) {
    entries_.erase(entry.key);
    if (keeps_mark) marks_.emplace_back(entry.key, entry.revision);
    return;
  }
  Json value = Json::parse(entry.value, nullptr, false);
  if (!value.is_object()) {
    log_error("the entry {} of the cluster's saved data is invalid", entry.key);
    entries_.erase(entry.key);
    return;
  }
  entries_[entry.key] = std::move(value);
}

void SavedIndex::drop_old_marks() {
  while (!marks_.empty() && marks_.front().second + kept_changes_ <= revision_) {
    bucket_.drop_mark(marks_.front().first, marks_.front().second);
    marks_.pop_front();
  }
}

}  // namespace vat
