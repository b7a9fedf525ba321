#include "server/storage/journal.h"

#include <cmath>
#include <exception>
#include <utility>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

using Seconds = std::chrono::duration<double>;

}  // namespace

Journal::Journal(MainDatabase& main, const Clock& clock)
    : main_(main), clock_(clock), thread_([this] { run(); }) {}

Journal::~Journal() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  wakes_.notify_one();
  thread_.join();
}

void Journal::post(Write write, Done done) {
  VAT_CHECK(write != nullptr);
  {
    const std::lock_guard lock(mutex_);
    waiting_.push_back({std::move(write), std::move(done), clock_.now()});
    ++posted_;
  }
  wakes_.notify_one();
}

void Journal::flush() {
  std::unique_lock lock(mutex_);
  idle_.wait(lock, [this, last = posted_] { return finished_ >= last; });
}

SteadyClock::duration Journal::expected_time() const {
  const std::lock_guard lock(mutex_);
  return std::chrono::duration_cast<SteadyClock::duration>(
      Seconds(mean_time_ + 4 * time_deviation_));
}

StorageCounts Journal::counts() const {
  const std::lock_guard lock(mutex_);
  return counts_;
}

void Journal::run() {
  std::unique_lock lock(mutex_);
  for (;;) {
    wakes_.wait(lock, [this] { return stopping_ || !waiting_.empty(); });
    if (waiting_.empty()) return;
    Group group = std::exchange(waiting_, {});
    const std::size_t count = group.size();
    lock.unlock();
    write(group);
    group.clear();  // what it holds may end with the caller of flush()
    lock.lock();
    finished_ += count;
    idle_.notify_all();
  }
}

void Journal::write(Group& group) {
  const Failure failure = try_write(group);
  if (!failure || group.size() == 1) return finish(group, failure);
  // One long entry may not fit on the disk, although the others do.
  for (Entry& entry : group) finish({&entry, 1}, try_write({&entry, 1}));
}

Journal::Failure Journal::try_write(std::span<Entry> entries) {
  const auto begin = CostClock::now();
  Failure failure;
  std::string reason;
  try {
    const std::lock_guard lock(main_.mutex);
    Transaction transaction(main_.database);
    for (const Entry& entry : entries) entry.write();
    transaction.commit();
  } catch (const StorageError& error) {
    failure = error.kind();
    reason = error.what();
  } catch (const std::exception& error) {
    failure = StorageError::Kind::failed;
    reason = error.what();
  }
  const std::lock_guard lock(mutex_);
  if (failure && !counts_.failing) log_error("the journal cannot be written: {}", reason);
  if (!failure && counts_.failing) log_info("the journal is written again");
  counts_.failing = failure;
  if (!failure) {
    ++counts_.journal_commits;
    counts_.commit_time += CostClock::now() - begin;
  }
  return failure;
}

void Journal::finish(std::span<Entry> entries, Failure failure) {
  {
    const std::lock_guard lock(mutex_);
    (failure ? counts_.failures : counts_.journal_writes) += entries.size();
    for (const Entry& entry : entries) {
      const double time = Seconds(clock_.now() - entry.posted_at).count();
      time_deviation_ += (std::abs(time - mean_time_) - time_deviation_) / 4;
      mean_time_ += (time - mean_time_) / 8;
    }
  }
  for (const Entry& entry : entries) {
    if (!entry.done) continue;
    try {
      entry.done(failure);
    } catch (const std::exception& error) {
      log_error("after a write to the journal: {}", error.what());
    }
  }
}

}  // namespace vat
