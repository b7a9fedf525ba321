#include "server/replay/replay_player.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <utility>

#include "core/support/check.h"
#include "protocol/messages/describe.h"
#include "server/session/core/scene_loading.h"
#include "server/session/core/session_restore.h"
#include "server/storage/sqlite/compression.h"
#include "server/support/stage_clock.h"

namespace vat {
namespace {

[[noreturn]] void fail_replay(const std::string& what, const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, "the recording's " + what + ": " + why);
}

}  // namespace

ReplayPlayer::ReplayPlayer(const Recording& recording, const SessionEnvironment& environment)
    : recording_(recording), environment_(environment), hashes_(recording.hashes) {
  set_cache({});
}

void ReplayPlayer::compare_moments() {
  for (const RecordedMoment& moment : recording_.moments) {
    hashes_.push_back({moment.position, moment.sequence, load_state(moment).state_hash()});
  }
  std::ranges::stable_sort(hashes_, {}, key_of);
}

Simulation ReplayPlayer::load_state(const RecordedMoment& moment) const {
  Result<Simulation> simulation =
      Simulation::load(decompress(moment.state, max_state_bytes(environment_.limits)),
                       &environment_.runner, recording_.instructions);
  if (!simulation) fail_replay("state", simulation.errors().front().message);
  return std::move(simulation).value();
}

Simulation ReplayPlayer::load_scene(std::uint64_t sequence) const {
  const auto entry = std::ranges::find(recording_.log, sequence, &LogEntry::sequence);
  if (entry == recording_.log.end()) fail_replay("scene", "its log entry is missing");
  return load_entry_scene(*entry, environment_, recording_.instructions);
}

Simulation ReplayPlayer::begin() const {
  if (const Status available = check_available(recording_.instructions); !available) {
    throw StorageError(StorageError::Kind::failed, available.errors().front().message);
  }
  Simulation simulation = load_scene(recording_.log.front().sequence);
  resume_on_device(simulation, simulation.scene(), environment_);
  return simulation;
}

void ReplayPlayer::go_to_begin(SessionCore& core) {
  if (!recording_.is_whole()) return go_to(core, recording_.moments.front());
  Simulation simulation = begin();
  const Snapshot as_loaded = simulation.snapshot();
  const LogEntry& first = recording_.log.front();
  const SessionMoment moment{.position = recording_.begin,
                             .sequence = first.sequence,
                             .loaded = first.sequence,
                             .participants = write_participants(Participants()),
                             .snapshot = as_loaded};
  resume(core, moment, std::move(simulation), as_loaded);
  find_place(core);
}

void ReplayPlayer::go_to(SessionCore& core, const RecordedMoment& moment) {
  Simulation simulation = load_state(moment);
  const SessionMoment read = read_moment(moment.fields, simulation.snapshot());
  if (read.position != moment.position || read.sequence != moment.sequence) {
    fail_replay("moment", "its content names another position");
  }
  if (auto error = find_excess(simulation, environment_.limits))
    fail_replay("state", error->message);
  if (const auto excess = core.run().admit(simulation)) {
    fail_replay("state", limit_reached(*excess).message);
  }
  const Snapshot& as_loaded = scene_as_loaded(read.loaded);
  if (!read.on_cpu) resume_on_device(simulation, as_loaded.scene(), environment_);
  resume(core, read, std::move(simulation), as_loaded);
  find_place(core);
}

const Snapshot& ReplayPlayer::scene_as_loaded(std::uint64_t sequence) {
  if (!loaded_ || loaded_->sequence != sequence) {
    loaded_.emplace(Loaded{sequence, load_scene(sequence).snapshot()});
  }
  return loaded_->scene;
}

void ReplayPlayer::find_place(const SessionCore& core) {
  const std::uint64_t sequence = core.history().sequence();
  const auto entry = std::ranges::upper_bound(recording_.log, sequence, {}, &LogEntry::sequence);
  next_entry_ = static_cast<std::size_t>(entry - recording_.log.begin());
  VAT_CHECK(next_entry_ <= recording_.log.size());
  const auto hash =
      std::ranges::lower_bound(hashes_, std::pair(core.run().position(), sequence), {}, key_of);
  next_hash_ = static_cast<std::size_t>(hash - hashes_.begin());
  same_until_ = core.run().tick();
  work_ = work_.zero();
}

void ReplayPlayer::execute_here(SessionCore& core) {
  for (; next_entry_ < recording_.log.size(); ++next_entry_) {
    compare_here(core);
    const LogEntry& entry = recording_.log[next_entry_];
    if (entry.position != core.run().position()) return;
    repeat_recorded_entry(core, entry);
  }
  compare_here(core);
}

void ReplayPlayer::compare_here(const SessionCore& core) {
  const auto here = std::pair(core.run().position(), core.history().sequence());
  for (; next_hash_ < hashes_.size() && key_of(hashes_[next_hash_]) <= here; ++next_hash_) {
    const RecordedHash& expected = hashes_[next_hash_];
    if (key_of(expected) < here) continue;  // the recording has no such position
    const std::uint64_t hash = core.run().simulation().state_hash();
    if (hash != expected.hash) {
      throw Diverged("at tick " + std::to_string(core.run().tick()) + " the state has the hash " +
                     describe_hash(hash) + ", and was recorded with " +
                     describe_hash(expected.hash) + "; the states are equal up to tick " +
                     std::to_string(same_until_));
    }
    same_until_ = core.run().tick();
    if (on_same) on_same(expected);
  }
}

std::shared_ptr<const RecordedMoment> ReplayPlayer::find_moment(std::uint64_t position) const {
  const auto after =
      std::ranges::upper_bound(recording_.moments, position, {}, &RecordedMoment::position);
  auto kept = kept_->find(position);
  if (after == recording_.moments.begin()) return kept;
  const RecordedMoment& own = *(after - 1);
  if (kept != nullptr && kept->position > own.position) return kept;
  return {std::shared_ptr<void>(), &own};  // the recording's, not to be deleted
}

void ReplayPlayer::keep(const SessionCore& core) {
  const SessionMoment moment = core.history().moment();
  kept_->add(
      {moment.position, moment.sequence, moment.fields(), compress(moment.snapshot.to_bytes())});
}

void ReplayPlayer::play_to(SessionCore& core, std::uint64_t position,
                           const std::atomic<bool>& cancelled) {
  execute_here(core);
  while (core.run().position() < std::min(position, recording_.end)) {
    const auto begin = thread_time();
    run_to(core, core.run().position() + 1, cancelled);
    execute_here(core);
    work_ += thread_time() - begin;
    const auto last = find_moment(core.run().position());
    const bool is_there = last != nullptr && last->position == core.run().position();
    if (!is_there && work_ < kept_->work()) continue;
    if (!is_there) keep(core);
    work_ = work_.zero();
  }
}

void ReplayPlayer::begin_seek(SessionCore& core, std::uint64_t position) {
  position = std::clamp(position, recording_.begin, recording_.end);
  const auto from = find_moment(position);
  const std::uint64_t present = core.run().position();
  const bool goes_on = present <= position && (from == nullptr || from->position <= present);
  if (goes_on) return find_place(core);
  if (from == nullptr) return go_to_begin(core);
  go_to(core, *from);
}

void ReplayPlayer::seek(SessionCore& core, std::uint64_t position,
                        const std::atomic<bool>& cancelled) {
  begin_seek(core, position);
  play_to(core, std::clamp(position, recording_.begin, recording_.end), cancelled);
}

}  // namespace vat
