#include "server/replay/session_recovery.h"

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "protocol/messages/describe.h"
#include "server/replay/log_replay.h"
#include "server/session/core/session_restore.h"
#include "server/support/log.h"

namespace vat {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, what + ": " + why);
}

}  // namespace

SessionRecovery::SessionRecovery(Storage& storage, StoredSession stored,
                                 const SessionEnvironment& environment,
                                 const std::atomic<bool>& cancelled)
    : storage_(storage),
      stored_(std::move(stored)),
      environment_(environment),
      cancelled_(cancelled) {}

Simulation SessionRecovery::begin() {
  const Result<InstructionSet> instructions = parse_instruction_set(stored_.instruction_set);
  if (!instructions) fail("its instruction set", instructions.errors().front().message);
  if (const Status available = check_available(instructions.value()); !available) {
    throw StorageError(StorageError::Kind::failed, available.errors().front().message);
  }
  instructions_ = instructions.value();
  Simulation simulation = find_begin();
  if (!start_ || !start_->moment.on_cpu) {
    resume_on_device(simulation, start_ ? start_->as_loaded.scene() : simulation.scene(),
                     environment_);
  }
  return simulation;
}

Simulation SessionRecovery::find_begin() {
  const std::vector<CheckpointPlace> places = storage_.checkpoints().places(stored_.number);
  if (const auto recent =
          find_recent(places.empty() ? std::nullopt : std::optional(places.back()))) {
    if (auto simulation = begin_at(*recent)) return *std::move(simulation);
  }
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    if (auto simulation = begin_at_place(*place)) return *std::move(simulation);
  }
  return begin_at_scene();
}

std::optional<Checkpoint> SessionRecovery::find_recent(
    const std::optional<CheckpointPlace>& newest) {
  std::optional<Checkpoint> recent = storage_.recent_states().read(stored_.number);
  if (!recent) return {};
  const auto moment_of = [](const auto& one) { return std::pair(one.position, one.sequence); };
  if ((!newest || moment_of(*recent) > moment_of(*newest)) &&
      recent->sequence <= storage_.sessions().last_sequence(stored_.number)) {
    return recent;
  }
  storage_.recent_states().remove(stored_.number);
  return {};
}

std::optional<Simulation> SessionRecovery::begin_at_place(const CheckpointPlace& place) {
  try {
    const std::optional<Checkpoint> checkpoint = storage_.checkpoints().read(place);
    if (checkpoint) return begin_at(*checkpoint);
  } catch (const StorageError& error) {
    log_warning("session s{}: its checkpoint at {} is skipped: {}", stored_.number, place.position,
                error.what());
  }
  return {};
}

std::optional<Simulation> SessionRecovery::begin_at(const Checkpoint& checkpoint) {
  try {
    Result<Simulation> simulation =
        Simulation::load(checkpoint.state, &environment_.runner, instructions_);
    if (!simulation) fail("its state", simulation.errors().front().message);
    SessionMoment moment = read_moment(checkpoint.fields, simulation.value().snapshot());
    const Simulation as_loaded = load_scene(moment.loaded);
    start_.emplace(Start{std::move(moment), as_loaded.snapshot()});
    return std::move(simulation).value();
  } catch (const StorageError& error) {
    log_warning("session s{}: its state at {} is skipped: {}", stored_.number, checkpoint.position,
                error.what());
    return {};
  }
}

Simulation SessionRecovery::begin_at_scene() {
  const std::vector<LogEntry> log = storage_.sessions().read(stored_.number, 0);
  if (log.empty() || log.front().sequence != 1)
    fail("its log", "the beginning of the log is missing");
  if (log.size() > 1 && log[1].sequence != 2)
    fail("its log", "the beginning of the log is missing");
  return load_scene(1);
}

Simulation SessionRecovery::load_scene(std::uint64_t sequence) {
  const std::optional<LogEntry> entry = storage_.sessions().find(stored_.number, sequence);
  if (!entry) fail("its scene", "the log entry is missing");
  return load_entry_scene(*entry, environment_, instructions_);
}

void SessionRecovery::repeat_log(SessionCore& core) {
  VAT_CHECK(core.history().log() == nullptr);
  const auto begin = CostClock::now();
  try {
    if (start_) {
      // The core has the checkpoint's simulation already.
      Simulation simulation = std::move(core.run().simulation());
      resume(core, start_->moment, std::move(simulation), start_->as_loaded);
    }
    execute_log(core);
    check_device_is_used(core);
  } catch (const Diverged& difference) {
    diverge(core, {core.run().position(), core.run().tick(), difference.what()});
  }
  work_ = CostClock::now() - begin;
}

void SessionRecovery::finish(SessionCore& core, const SessionEnvironment& environment) {
  core.set_environment(environment);
  // The log may lack all entries before the state at which the recovery began.
  const std::uint64_t last =
      std::max(storage_.sessions().last_sequence(stored_.number), core.history().sequence());
  const std::uint64_t position = core.run().position();
  storage_.checkpoints().drop_hashes(stored_.number, position);
  const auto replica =
      environment.replicas == nullptr ? nullptr : environment.replicas->replica_of(stored_.number);
  if (replica != nullptr) {
    for (const std::uint64_t sequence : refused_) replica->refuse(sequence);
  }
  core.history().keep_in(std::make_unique<SessionLog>(
      storage_, stored_.number,
      SessionLog::Place{last, position, core.history().divergence().has_value(),
                        storage_.sessions().log_bytes(stored_.number), work_},
      replica));
  end_recovery(core, environment.clock.now());
}

void SessionRecovery::execute_log(SessionCore& core) {
  compare(core);
  std::uint64_t last = core.history().sequence();
  const auto newest =
      storage_.sessions().find(stored_.number, storage_.sessions().last_sequence(stored_.number));
  const std::uint64_t end = newest ? newest->position : 0;
  for (auto entries = storage_.sessions().read(stored_.number, last); !entries.empty();
       entries = storage_.sessions().read(stored_.number, last)) {
    for (const LogEntry& entry : entries) {
      if (entry.sequence != last + 1)
        fail("its log", "entries are missing before entry " + std::to_string(entry.sequence));
      last = entry.sequence;
      // The stored progress may be later than the last entry before it.
      if (stored_.progress && stored_.progress->sequence + 1 == entry.sequence) {
        run_to(core, stored_.progress->position, cancelled_);
        compare(core);
      }
      run_to(core, entry.position, cancelled_);
      if (entry.position < end) {
        repeat_entry(core, entry);
      } else {
        repeat_last_entry(core, entry);
      }
    }
  }
  if (stored_.progress && stored_.progress->sequence == last) {
    run_to(core, stored_.progress->position, cancelled_);
    compare(core);
  }
  run_to(core, stored_.reached, cancelled_);
}

void SessionRecovery::check_device_is_used(const SessionCore& core) const {
  const SessionRun& run = core.run();
  const bool was_lost =
      start_ && start_->moment.on_cpu && start_->moment.loaded == core.history().scene_sequence();
  if (!run.has_lost_device() || was_lost) return;
  throw Diverged("the CPU computes in place of the device " +
                 to_text(*run.as_loaded().scene().numerics.device));
}

void SessionRecovery::repeat_last_entry(SessionCore& core, const LogEntry& entry) {
  try {
    repeat_entry(core, entry);
  } catch (const Diverged& refusal) {
    log_info("session s{}: {}, as it was when the server ended", stored_.number, refusal.what());
    storage_.sessions().refuse(stored_.number, entry.sequence);
    refused_.push_back(entry.sequence);
  }
}

void SessionRecovery::compare(SessionCore& core) {
  const std::optional<SessionProgress>& progress = stored_.progress;
  if (!progress || progress->sequence != core.history().sequence() ||
      progress->position != core.run().position())
    return;
  const std::uint64_t hash = core.run().simulation().state_hash();
  if (hash != progress->hash) {
    throw Diverged("the state at position " + std::to_string(progress->position) +
                   " has the hash " + describe_hash(hash) + ", but the stored hash is " +
                   describe_hash(progress->hash));
  }
  apply_progress(core, *progress);
}

}  // namespace vat
