#include "server/session/session_recovery.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "server/session/describe.h"
#include "server/session/method_table.h"
#include "server/session/saved_state.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, what + ": " + why);
}

std::string name_of(const LogEntry& entry) {
  return "entry " + std::to_string(entry.sequence) + " (" + entry.method + ")";
}

Json parse_params(const LogEntry& entry) {
  Result<Json> json =
      parse_json(entry.params, {entry.params.size(), kMaxMessageDepth, entry.params.size() + 1});
  if (!json) fail(name_of(entry), json.errors().front().message);
  return std::move(json).value();
}

SessionAction read_action(const LogEntry& entry) {
  const Method* method = find_method(entry.method);
  const auto* read = method == nullptr ? nullptr : std::get_if<Method::ForSession>(&method->read);
  if (read == nullptr || !method->rules.is_logged) {
    fail(name_of(entry), "there is no such command in a log");
  }
  const Json json = parse_params(entry);
  Errors errors;
  ObjectReader params(json, "", errors);
  SessionAction action = (*read)(params, errors);
  params.refuse_unknown();
  if (!errors.empty()) fail(name_of(entry), errors.front().path + " " + errors.front().message);
  return action;
}

/// What a refused command has done all the same: a body that was beyond a limit has used an id.
void carry_out_refused(SessionCore& core, const LogEntry& entry) {
  if (entry.method != "world.add_body") return;
  const Snapshot before = core.run().simulation().snapshot();
  core.apply(entry, read_action(entry));
  core.run().simulation().restore(before);
}

}  // namespace

void carry_out_again(SessionCore& core, const LogEntry& entry) {
  if (entry.method == kLeaveEntry) return core.carry_out_leave(entry);
  if (entry.method == kLetGoEntry) return core.carry_out_let_go(entry);
  if (entry.refused) return carry_out_refused(core, entry);
  const bool restores = entry.method == kRestoreEntry;
  const ActionResult result =
      core.apply(entry, restores ? read_restore(parse_params(entry)) : read_action(entry));
  if (const auto* error = std::get_if<RpcError>(&result)) {
    throw Diverged(name_of(entry) + " is refused: " + error->message);
  }
}

void run_to(SessionCore& core, std::uint64_t position, const std::atomic<bool>& cancelled) {
  while (core.run().position() < position) {
    if (cancelled) throw Cancelled();
    if (core.tick(core.environment().clock.now(), false)) continue;
    throw Diverged("the tick after " + std::to_string(core.run().tick()) + " fails");
  }
}

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
  const std::vector<CheckpointPlace> places = storage_.checkpoints().places(stored_.number);
  for (auto place = places.rbegin(); place != places.rend(); ++place) {
    if (auto simulation = begin_at(*place)) return *std::move(simulation);
  }
  return begin_at_scene();
}

std::optional<Simulation> SessionRecovery::begin_at(const CheckpointPlace& place) {
  try {
    const std::optional<Checkpoint> checkpoint = storage_.checkpoints().read(place);
    if (!checkpoint) return {};
    Result<Simulation> simulation =
        Simulation::load(checkpoint->state, &environment_.runner, instructions_);
    if (!simulation) fail("its state", simulation.errors().front().message);
    SessionMoment moment = read_moment(checkpoint->fields, simulation.value().snapshot());
    const Simulation as_loaded = load_scene(moment.loaded);
    start_.emplace(Start{std::move(moment), as_loaded.snapshot()});
    return std::move(simulation).value();
  } catch (const StorageError& error) {
    spdlog::warn("session s{}: its checkpoint at {} is passed over: {}", stored_.number,
                 place.position, error.what());
    return {};
  }
}

Simulation SessionRecovery::begin_at_scene() {
  const std::vector<LogEntry> log = storage_.sessions().read(stored_.number, 0);
  if (log.empty() || log.front().sequence != 1) fail("its log", "the beginning is gone");
  if (log.size() > 1 && log[1].sequence != 2) fail("its log", "the beginning is gone");
  return load_scene(1);
}

Simulation SessionRecovery::load_scene(std::uint64_t sequence) {
  const std::optional<LogEntry> entry = storage_.sessions().find(stored_.number, sequence);
  if (!entry) fail("its scene", "the entry is gone");
  const Json params = parse_params(*entry);
  const auto scene = params.find("scene");
  if (scene == params.end()) fail("its scene", "the entry has none");
  auto read = read_client_scene(*scene, environment_.catalogue);
  if (const auto* error = std::get_if<RpcError>(&read)) fail("its scene", error->message);
  auto simulation = make_simulation(std::get<Scene>(read), environment_, instructions_);
  if (const auto* error = std::get_if<RpcError>(&simulation)) fail("its scene", error->message);
  return std::get<Simulation>(std::move(simulation));
}

void SessionRecovery::finish(SessionCore& core) {
  try {
    if (start_) {
      // The core has the simulation already: it goes there from the snapshot with the same bits.
      Simulation simulation = std::move(core.run().simulation());
      core.resume(start_->moment, std::move(simulation), start_->as_loaded);
    }
    carry_out_log(core);
  } catch (const Diverged& difference) {
    core.set_divergence({core.run().position(), core.run().tick(), difference.what()});
  }
}

void SessionRecovery::carry_out_log(SessionCore& core) {
  compare(core);
  std::uint64_t last = core.sequence();
  const auto newest =
      storage_.sessions().find(stored_.number, storage_.sessions().last_sequence(stored_.number));
  const std::uint64_t end = newest ? newest->position : 0;
  for (auto entries = storage_.sessions().read(stored_.number, last); !entries.empty();
       entries = storage_.sessions().read(stored_.number, last)) {
    for (const LogEntry& entry : entries) {
      if (entry.sequence != last + 1)
        fail("its log", "entries are missing before " + name_of(entry));
      last = entry.sequence;
      // A tick may lie between the last entry and where the session was seen, or behind it.
      if (stored_.beat && stored_.beat->sequence + 1 == entry.sequence) {
        run_to(core, stored_.beat->position, cancelled_);
        compare(core);
      }
      run_to(core, entry.position, cancelled_);
      if (entry.position < end) {
        carry_out_again(core, entry);
      } else {
        carry_out_at_end(core, entry);
      }
    }
  }
  if (stored_.beat && stored_.beat->sequence == last) {
    run_to(core, stored_.beat->position, cancelled_);
    compare(core);
  }
  run_to(core, stored_.reached, cancelled_);
}

void SessionRecovery::carry_out_at_end(SessionCore& core, const LogEntry& entry) {
  try {
    carry_out_again(core, entry);
  } catch (const Diverged& refusal) {
    spdlog::info("session s{}: {}, as it was when the server ended", stored_.number,
                 refusal.what());
    storage_.sessions().refuse(stored_.number, entry.sequence);
  }
}

void SessionRecovery::compare(SessionCore& core) {
  const std::optional<SessionProgress>& beat = stored_.beat;
  if (!beat || beat->sequence != core.sequence() || beat->position != core.run().position()) return;
  const std::uint64_t hash = core.run().simulation().state_hash();
  if (hash != beat->hash) {
    throw Diverged("the state at position " + std::to_string(beat->position) + " has the hash " +
                   describe_hash(hash) + ", and was seen with " + describe_hash(beat->hash));
  }
  core.pass(*beat);
}

}  // namespace vat
