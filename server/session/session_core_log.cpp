// How commands go through the log, and how a session comes back from it.

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "server/session/method_table.h"
#include "server/session/saved_state.h"
#include "server/session/scene_loading.h"
#include "server/session/session_core.h"

namespace vat {
namespace {

/// Epochs that clients may have seen after the last one that was written down.
constexpr std::uint32_t kSkippedEpochs = 1000;

}  // namespace

std::vector<ActionResult> SessionCore::carry_out(std::span<const ParticipantCommand> commands) {
  std::vector<LogEntry> entries;
  std::vector<std::variant<Prepared, RpcError>> prepared;
  for (const ParticipantCommand& given : commands) {
    if (!given.command.rules->is_logged) continue;
    prepared.push_back(prepare(given));
    if (auto* good = std::get_if<Prepared>(&prepared.back())) {
      entries.push_back(std::move(good->entry));
    }
  }
  if (auto error = log(entries)) return std::vector<ActionResult>(commands.size(), *error);

  std::vector<ActionResult> results;
  auto entry = entries.begin();
  auto next = prepared.begin();
  for (const ParticipantCommand& given : commands) {
    if (!given.command.rules->is_logged) {
      results.push_back(act(given.participant, given.command.action));
      continue;
    }
    const std::variant<Prepared, RpcError>& one = *next++;
    if (const auto* error = std::get_if<RpcError>(&one)) {
      results.push_back(*error);
      continue;
    }
    const auto& action = std::get<Prepared>(one).action;
    results.push_back(apply(*entry, action ? *action : given.command.action));
    if (std::holds_alternative<RpcError>(results.back())) refuse(*entry);
    ++entry;
  }
  return results;
}

std::variant<SessionCore::Prepared, RpcError> SessionCore::prepare(
    const ParticipantCommand& given) const {
  const std::string_view method = given.command.rules->method;
  try {
    if (method == kLoadMethod) return prepare_load(given);
    if (method == kLoadStateMethod) return prepare_restore(given);
  } catch (const StorageError& error) {
    spdlog::error("session {}: {}", id_, error.what());
    return storage_failed(error.kind());
  }
  return Prepared{make_entry(given.participant, method, given.command.params.dump()), {}};
}

// A scene that has a name is written out: the name may stand for another one day.
std::variant<SessionCore::Prepared, RpcError> SessionCore::prepare_load(
    const ParticipantCommand& given) const {
  Json params = given.command.params;
  std::optional<SessionAction> action;
  Json& scene = params.at("scene");
  if (const Scene* named = scene.is_string()
                               ? environment_->catalogue.find(scene.get_ref<const std::string&>())
                               : nullptr) {
    scene = write_scene(*named);
  } else if (scene.is_string()) {
    auto saved = find_saved_scene(scene.get_ref<const std::string&>(), *environment_);
    if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
    scene = std::get<Json>(std::move(saved));
    action = make_command(kLoadMethod, params).action;
  }
  return Prepared{make_entry(given.participant, kLoadMethod, params.dump()), std::move(action)};
}

std::variant<SessionCore::Prepared, RpcError> SessionCore::prepare_restore(
    const ParticipantCommand& given) const {
  const auto& name = given.command.params.at("name").get_ref<const std::string&>();
  SavedStates* const states = environment_->states;
  const auto state = states == nullptr ? std::nullopt : states->find(id_, name);
  if (!state) return no_such_state(name);
  const Json params = params_of_restore(*state);
  return Prepared{make_entry(given.participant, kRestoreEntry, params.dump()),
                  read_restore(params)};
}

LogEntry SessionCore::make_entry(ParticipantNumber participant, std::string_view method,
                                 std::string params) const {
  return {0,    run_.position(), run_.tick(), participant, std::string(method), std::move(params),
          false};
}

std::optional<RpcError> SessionCore::log(std::span<LogEntry> entries) {
  if (entries.empty()) return {};
  if (log_ == nullptr) {
    // What those who watch a replay do is beside its log.
    const bool counts = replay_ == nullptr;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      entries[i].sequence = sequence_ + (counts ? 1 + i : 0);
    }
    return {};
  }
  if (divergence_) {
    // Somebody goes on from here: the log does not lead here, so that a checkpoint has to.
    sequence_ = log_->last();
    log_->keep(moment(), environment_->clock.now(), true);
  }
  try {
    log_->append(entries);
  } catch (const StorageError& error) {
    if (!std::exchange(log_fails_, true)) {
      spdlog::error("session {}: commands are refused, they cannot be logged: {}", id_,
                    error.what());
    }
    return storage_failed(error.kind());
  }
  if (std::exchange(log_fails_, false)) spdlog::info("session {}: commands are logged again", id_);
  return {};
}

std::optional<RpcError> SessionCore::reach() {
  if (log_ == nullptr) return {};
  try {
    log_->reach(run_.position());
    return {};
  } catch (const StorageError& error) {
    return storage_failed(error.kind());
  }
}

void SessionCore::refuse(const LogEntry& entry) {
  if (log_ == nullptr) return;
  try {
    log_->refuse(entry.sequence);
  } catch (const StorageError& error) {
    // Carried out again it is refused alike, unless the server's limits are others then.
    spdlog::error("session {}: entry {}: {}", id_, entry.sequence, error.what());
  }
}

ActionResult SessionCore::apply(const LogEntry& entry, const SessionAction& action) {
  sequence_ = entry.sequence;
  return act(entry.participant, action);
}

ActionResult SessionCore::act(ParticipantNumber participant, const SessionAction& action) {
  try {
    return action(*this, participants_.ghost(participant));
  } catch (const StorageError& error) {
    spdlog::error("session {}: {}", id_, error.what());
    return storage_failed(error.kind());
  } catch (const std::exception& error) {
    spdlog::error("session {}: a command failed: {}", id_, error.what());
    return internal_error();
  }
}

SessionMoment SessionCore::moment() const {
  return {run_.position(),
          run_.tick(),
          sequence_,
          loaded_,
          last_grab_,
          run_.epoch(),
          playing_,
          speed_,
          participants_.changes(),
          write_participants(participants_),
          run_.simulation().snapshot()};
}

void SessionCore::resume(const SessionMoment& moment, Simulation simulation, Snapshot as_loaded) {
  run_.resume(std::move(simulation), std::move(as_loaded), moment.position, moment.tick,
              moment.epoch);
  frames_->set_vat(run_.simulation().scene().vat);
  sequence_ = moment.sequence;
  loaded_ = moment.loaded;
  last_grab_ = moment.last_grab;
  playing_ = moment.playing;
  speed_ = moment.speed;
  participants_ = {};
  read_participants(moment.participants, participants_);
}

void SessionCore::pass(const SessionProgress& beat) {
  playing_ = beat.playing;
  speed_ = beat.speed;
  Participants present;
  const Result<Json> json =
      parse_json(beat.participants, {beat.participants.size(), 16, beat.participants.size()});
  if (!json) throw StorageError(StorageError::Kind::corrupt, "a stored session: participants");
  read_participants(json.value(), present);
  participants_ = std::move(present);
}

void SessionCore::come_back(SteadyClock::time_point now) {
  take_interruption();
  run_.skip_epochs(kSkippedEpochs);
  start_epoch();
  if (divergence_) {
    // The log stays as it is, for as long as nobody goes on from here.
    const ParticipantNumber last = participants_.last_number();
    participants_ = {};
    participants_.skip_to(last);
    return;
  }
  std::vector<ParticipantNumber> lost;  // who came when nobody wrote it down
  for (const auto& [number, participant] : participants_.all()) {
    if (participant.resume) {
      environment_->tokens.add(*participant.resume, {Role::viewer, id_});
    } else {
      lost.push_back(number);
    }
  }
  participants_.send_away(now);
  for (const ParticipantNumber number : lost) leave(number);
}

void SessionCore::set_divergence(Divergence divergence) {
  spdlog::error("session {}: it came back in another state than it was in, and stands still: {}",
                id_, divergence.reason);
  divergence_ = std::move(divergence);
  set_playing(false);
}

void SessionCore::tell_divergence() {
  if (!std::exchange(divergence_due_, false) || !divergence_) return;
  participants_.send_event(write_event("session.diverged", {{"position", divergence_->position},
                                                            {"tick", divergence_->tick},
                                                            {"reason", divergence_->reason}}));
}

}  // namespace vat
