#include "server/session/core/session_core.h"

#include <exception>
#include <utility>

#include "core/support/check.h"
#include "server/session/core/command_entry.h"
#include "server/support/log.h"

namespace vat {

namespace {

/// Ends the permission of the governor, which belongs to the scene before.
void start_loaded_scene(SessionHistory& history, Participants& participants,
                        const SessionPeople& people) {
  const bool was_governed = !history.governor_points().empty();
  history.mark_scene();
  if (!was_governed) return;
  participants.send_event(write_event("session.configured", people.describe_settings()));
}

}  // namespace

SessionCore::SessionCore(std::string id, SessionSettings settings, Simulation simulation,
                         const SessionEnvironment& environment)
    : SessionCore(std::move(id), std::move(settings), std::move(simulation),
                  environment.resources.take_anyway({}), environment) {
  run_.resize_share_anyway();
}

SessionCore::SessionCore(std::string id, SessionSettings settings, Simulation simulation,
                         ResourceShare share, const SessionEnvironment& environment)
    : context_{std::move(id), std::move(settings), &environment, nullptr, {}},
      run_(std::move(simulation), std::move(share), environment.metrics),
      history_(context_, run_, clock_, participants_),
      notifier_(context_, run_, clock_, history_, participants_, recorded_),
      people_(context_, run_, participants_, history_, notifier_) {}

void SessionCore::set_environment(const SessionEnvironment& environment) {
  context_.environment = &environment;
  run_.move_share(environment.resources);
}

void SessionCore::set_playing(bool playing) {
  VAT_CHECK(context_.owner.allows_this_thread());
  if (clock_.playing() && !playing) notifier_.mark_frame();  // clients may lack the last state
  clock_.set_playing(playing);
  notifier_.mark_status();
}

void SessionCore::set_speed(double speed) {
  clock_.set_speed(speed);
  notifier_.mark_status();
}

void SessionCore::load(Simulation simulation) {
  run_.load(std::move(simulation));
  start_loaded_scene(history_, participants_, people_);
  start_scene();
  clock_.restart_rate();
}

void SessionCore::restore(Simulation simulation, const Simulation& as_loaded, std::uint64_t tick) {
  run_.restore(std::move(simulation), as_loaded, tick);
  start_loaded_scene(history_, participants_, people_);
  start_scene();
  clock_.restart_rate();
}

void SessionCore::reset() {
  run_.reset();
  start_scene();
}

void SessionCore::start_scene() {
  VAT_CHECK(context_.owner.allows_this_thread());
  history_.clear_divergence();
  participants_.forget_grabs();
  clock_.interrupt();
  notifier_.reset_frames();
  notifier_.start_epoch();
}

void SessionCore::start_epoch(bool moved) {
  VAT_CHECK(context_.owner.allows_this_thread());
  if (moved) notifier_.forget_velocities();
  // Moved bodies need an epoch too: a paused session shows no second frame of a tick.
  run_.start_epoch();
  notifier_.start_epoch();
}

bool SessionCore::tick(SteadyClock::time_point now, bool timed) {
  VAT_CHECK(context_.owner.allows_this_thread());
  notifier_.prepare_tick();
  const AdvanceReport report = run_.advance();
  notifier_.tell_guard(report);
  if (report.device_error) leave_device(*report.device_error, now);
  if (report.failed) {
    log_warning("session {}: paused by the guard at tick {}", context_.id, run_.tick());
    set_playing(false);
    return false;
  }
  for (const std::uint64_t grab : report.ended_grabs) participants_.forget_grab(grab);
  if (report.bodies_changed) start_epoch();
  if (timed) clock_.tick_done(now, run_.tick_seconds());
  return true;
}

void SessionCore::leave_device(const Error& error, SteadyClock::time_point now) {
  log_warning("session {}: the CPU continues: {}: {}", context_.id, error.path, error.message);
  notifier_.tell_device(error);
  if (!run_.has_lost_device() || history_.log() == nullptr) return;
  history_.log()->store(history_.moment(), now, true);
}

CommandBatch SessionCore::prepare(std::span<const ParticipantCommand> commands) const {
  VAT_CHECK(context_.owner.allows_this_thread());
  CommandBatch batch;
  for (const ParticipantCommand& command : commands) {
    CommandBatch::Item& item = batch.items.emplace_back(CommandBatch::Item{command, {}, {}});
    if (!command.command.row->is_logged()) continue;
    auto made = make_command_entry(environment(), history_, command);
    if (auto* entry = std::get_if<CommandEntry>(&made)) {
      batch.entries.push_back(std::move(entry->entry));
      item.action = std::move(entry->action);
    } else {
      item.error = std::get<RpcError>(std::move(made));
    }
  }
  return batch;
}

std::vector<ActionResult> SessionCore::execute(const CommandBatch& batch,
                                               std::span<const LogEntry> entries,
                                               const std::optional<RpcError>& failure) {
  VAT_CHECK(context_.owner.allows_this_thread());
  std::vector<ActionResult> results;
  auto entry = entries.begin();
  for (const CommandBatch::Item& item : batch.items) {
    const auto& [participant, command] = item.command;
    if (item.error) {
      results.push_back(*item.error);
    } else if (!command.row->is_logged()) {
      results.push_back(act(participant, command.action));
    } else if (failure) {
      results.push_back(*failure);
    } else {
      VAT_CHECK(entry != entries.end());
      results.push_back(execute(*entry, item.action ? *item.action : command.action));
      if (std::holds_alternative<RpcError>(results.back())) history_.refuse(*entry);
      ++entry;
    }
  }
  VAT_CHECK(results.size() == batch.items.size());
  return results;
}

ActionResult SessionCore::execute(const LogEntry& entry, const SessionAction& action) {
  history_.execute(entry);
  return act(entry.participant, action);
}

ActionResult SessionCore::act(ParticipantNumber participant, const SessionAction& action) {
  VAT_CHECK(action != nullptr);
  try {
    if (participant == kServerItself) {
      Participant server;
      return action(*this, server);
    }
    return action(*this, participants_.find_or_add(participant));
  } catch (const StorageError& error) {
    log_error("session {}: {}", context_.id, error.what());
    return storage_failed(error.kind());
  } catch (const std::exception& error) {
    log_error("session {}: a command failed: {}", context_.id, error.what());
    return internal_error();
  }
}

std::vector<SessionCore::IdleGrab> SessionCore::idle_grabs(SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  std::vector<IdleGrab> idle;
  for (const auto& [number, holder] : participants_.all()) {
    auto& uses = participants_.find(number)->grab_uses;
    for (const auto& [grab, body] : holder.grabs) {
      // A recovered grab has no use yet: its idle time starts now.
      const auto used = uses.try_emplace(grab, now).first->second;
      if (now - used >= environment().limits.grab_idle) idle.push_back({number, grab, body});
    }
  }
  return idle;
}

void SessionCore::tell_idle_grab(const IdleGrab& idle) {
  if (participants_.holder_of(idle.grab) != nullptr) return;  // not logged; the next check retries
  participants_.send_event(write_event("grab.ended", {{"grab", idle.grab},
                                                      {"body", idle.body},
                                                      {"participant", idle.participant},
                                                      {"reason", "idle"}}));
}

}  // namespace vat
