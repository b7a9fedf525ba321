// How commands go through the log, and how a session comes back from it.

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "server/session/scene_loading.h"
#include "server/session/session_core.h"

namespace vat {
namespace {

/// Epochs that clients may have seen after the last one that was written down.
constexpr std::uint32_t kSkippedEpochs = 1000;

/// A scene of the catalogue is written out: the catalogue may be another one day.
Json params_to_log(const SessionCommand& command, const Catalogue& catalogue) {
  if (command.rules->method != kLoadMethod) return command.params;
  const Json& scene = command.params.at("scene");
  const Scene* named =
      scene.is_string() ? catalogue.find(scene.get_ref<const std::string&>()) : nullptr;
  return named == nullptr ? command.params : Json{{"scene", write_scene(*named)}};
}

}  // namespace

std::vector<ActionResult> SessionCore::carry_out(std::span<const Given> commands) {
  std::vector<LogEntry> entries;
  for (const Given& given : commands) {
    if (!given.command.rules->is_logged) continue;
    const Json params = params_to_log(given.command, environment_->catalogue);
    entries.push_back(make_entry(given.participant, given.command.rules->method, params.dump()));
  }
  if (auto error = log(entries)) return std::vector<ActionResult>(commands.size(), *error);

  std::vector<ActionResult> results;
  auto entry = entries.begin();
  for (const Given& given : commands) {
    if (!given.command.rules->is_logged) {
      results.push_back(act(given.participant, given.command.action));
      continue;
    }
    results.push_back(apply(*entry, given.command.action));
    if (std::holds_alternative<RpcError>(results.back())) refuse(*entry);
    ++entry;
  }
  return results;
}

LogEntry SessionCore::make_entry(ParticipantNumber participant, std::string_view method,
                                 std::string params) const {
  return {0,    run_.position(), run_.tick(), participant, std::string(method), std::move(params),
          false};
}

std::optional<RpcError> SessionCore::log(std::span<LogEntry> entries) {
  if (entries.empty()) return {};
  if (log_ == nullptr) {
    for (std::size_t i = 0; i < entries.size(); ++i) entries[i].sequence = sequence_ + 1 + i;
    return {};
  }
  if (divergence_) {
    // Somebody goes on from here: the log does not lead here, so that a checkpoint has to.
    sequence_ = log_->last();
    log_->keep(moment(), SteadyClock::now(), true);
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
  read_participants(moment.participants, participants_);
}

void SessionCore::pass(const SessionBeat& beat) {
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
