#include "server/replay/replay_run.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "core/support/check.h"
#include "protocol/json/printable.h"
#include "server/people/person_name.h"
#include "server/replay/foreign_text.h"
#include "server/replay/log_replay.h"
#include "server/session/core/saved_state.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::size_t kMaxReason = 1000;  // bytes
constexpr auto kPeopleInterval = std::chrono::milliseconds(100);
constexpr MomentCache::Seconds kWork{0.04};  // between two moments; a seek then takes 0.2 s
constexpr std::size_t kMaxMomentBytes = std::size_t{128}
                                        << 20;  // in addition to the recording's own

/// Pointers are not recorded. The target of a grab replaces them.
Json describe_hand(const SessionCore& core, const Participant& person) {
  if (person.grabs.empty()) return nullptr;
  const std::optional<Vec3> target =
      core.run().simulation().grab_target(person.grabs.rbegin()->first);
  return target ? Json{{"position", to_json(*target)}} : Json();
}

/// While it exists, the recorded participants are those of the core.
class RecordedParticipants {
 public:
  explicit RecordedParticipants(SessionCore& core) : core_(core) { exchange(); }
  ~RecordedParticipants() { exchange(); }
  RecordedParticipants(const RecordedParticipants&) = delete;
  RecordedParticipants& operator=(const RecordedParticipants&) = delete;

 private:
  void exchange() { std::swap(core_.participants(), core_.recorded()); }

  SessionCore& core_;
};

void start_epoch(SessionCore& core, std::uint32_t epoch) {
  core.run().set_epoch(epoch);
  core.clock().restart_rate();
  core.notifier().start_epoch();
}

}  // namespace

ReplayRun::ReplayRun(std::shared_ptr<const Recording> recording,
                     const SessionEnvironment& environment)
    : recording_(std::move(recording)),
      environment_(environment),
      moments_(std::make_shared<MomentCache>(kWork, kMaxMomentBytes)),
      player_(*recording_, environment_) {
  player_.share(moments_);
  read_names();
}

/// Joins are not logged, but checkpoints contain the names.
void ReplayRun::read_names() {
  for (const RecordedMoment& moment : recording_->moments) {
    const Result<Json> fields = parse_json(moment.fields, {moment.fields.size(), 16, 100'000});
    if (!fields || !fields.value().is_object()) continue;
    Participants people;
    try {
      read_participants(fields.value().value("participants", Json()), people);
    } catch (const StorageError&) {
      continue;  // a seek to it reports the error
    }
    for (const auto& [number, person] : people.all()) {
      names_[number] = is_showable_name(person.name) ? person.name : printable(person.name);
    }
  }
}

template <class Action>
bool ReplayRun::with_recorded(SessionCore& core, Action&& action) {
  const bool playing = core.clock().playing();
  const double speed = core.clock().speed();
  std::string difference;
  {
    const RecordedParticipants recorded(core);
    try {
      action();
    } catch (const Diverged& error) {
      difference = error.what();
    } catch (const StorageError& error) {
      difference = error.what();
    }
  }
  core.clock().set(playing, speed);
  if (difference.empty()) return true;
  diverge(core, difference);
  return false;
}

void ReplayRun::diverge(SessionCore& core, const std::string& reason) {
  log_warning("session {}: the recording differs: {}", core.id(), reason);
  player_.stop_comparing();
  core.set_playing(false);
  divergence_ = Json{{"position", core.run().position()},
                     {"tick", core.run().tick()},
                     {"reason", fit_to_tell(reason, kMaxReason)}};
  core.participants().send_event(write_event("replay.diverged", *divergence_));
}

void ReplayRun::start(SessionCore& core) {
  VAT_CHECK(filler_ == nullptr);
  core.set_playback(this);
  with_recorded(core, [&] { player_.go_to_begin(core); });
  core.clock().set(false, 1);
  start_epoch(core, epoch_);
  core.clock().take_interruption();
  filler_ = std::make_unique<MomentFiller>(recording_, environment_, moments_);
}

bool ReplayRun::tick(SessionCore& core, SteadyClock::time_point now, bool timed) {
  VAT_CHECK(core.playback() == this);
  const std::uint64_t before = core.run().position();
  const bool same = with_recorded(
      core, [&] { player_.play_to(core, std::min(before + 1, recording_->end), cancelled_); });
  epoch_ = core.run().epoch();
  const bool has_run = core.run().position() > before;
  if (has_run && timed) core.clock().tick_done(now, core.run().tick_seconds());
  if (same && core.run().position() >= recording_->end) {
    core.set_playing(false);
    core.participants().send_event(write_event(
        "replay.ended", {{"position", core.run().position()}, {"tick", core.run().tick()}}));
  }
  return has_run;
}

void ReplayRun::begin_seek(SessionCore& core, std::uint64_t position) {
  divergence_.reset();
  target_ = std::clamp(position, recording_->begin, recording_->end);
  if (!with_recorded(core, [&] { player_.begin_seek(core, target_); })) target_ = 0;
}

bool ReplayRun::continue_seek(SessionCore& core, CostClock::time_point until) {
  bool same = true;
  const auto is_there = [&] { return !same || core.run().position() >= target_; };
  if (target_ == core.run().position()) {
    same = with_recorded(core, [&] { player_.play_to(core, target_, cancelled_); });
  }
  while (!is_there() && CostClock::now() < until) {
    same =
        with_recorded(core, [&] { player_.play_to(core, core.run().position() + 1, cancelled_); });
  }
  return is_there();
}

void ReplayRun::end_seek(SessionCore& core) {
  VAT_CHECK(core.playback() == this);
  start_epoch(core, ++epoch_);
}

std::optional<std::uint64_t> ReplayRun::find_tick(const SessionCore& core,
                                                  std::uint64_t tick) const {
  const std::uint64_t run_begin = core.run().position() - core.run().tick();
  const std::uint64_t wanted = run_begin + tick;
  if (wanted < recording_->begin || wanted > recording_->end) return {};
  const bool run_ends = std::ranges::any_of(recording_->log, [&](const LogEntry& entry) {
    return entry.sequence > core.history().sequence() && entry.position <= wanted &&
           !entry.refused &&
           (entry.method == "control.reset" || entry.method == kLoadMethod ||
            entry.method == kRestoreEntry);
  });
  if (run_ends) return {};
  return wanted;
}

Json ReplayRun::describe_people(const SessionCore& core) const {
  Json people = Json::array();
  for (const auto& [number, person] : core.recorded().all()) {
    if (people.size() == kMaxPresence) break;
    const auto name = names_.find(number);
    Json told = describe_participant(person);
    told.erase("participant");
    told.erase("away");
    told["person"] = number;
    told["name"] = name != names_.end() ? name->second : "participant " + std::to_string(number);
    told["pointer"] = describe_hand(core, person);
    people.push_back(std::move(told));
  }
  return people;
}

void ReplayRun::tell_people(SessionCore& core, SteadyClock::time_point now) {
  if (now < told_at_ + kPeopleInterval) return;
  Json people = describe_people(core);
  std::string text = people.dump();
  if (text == told_people_) return;
  told_people_ = std::move(text);
  told_at_ = now;
  core.participants().send_event(write_event("replay.people", {{"people", std::move(people)}}));
}

Json ReplayRun::describe(const SessionCore& core) const {
  std::vector<std::uint64_t> checkpoints = moments_->positions();
  for (const RecordedMoment& moment : recording_->moments) checkpoints.push_back(moment.position);
  std::ranges::sort(checkpoints);
  checkpoints.erase(std::unique(checkpoints.begin(), checkpoints.end()), checkpoints.end());
  return {{"name", recording_->name},
          {"begin", recording_->begin},
          {"end", recording_->end},
          {"position", core.run().position()},
          {"playing", core.clock().playing()},
          {"speed", core.clock().speed()},
          {"checkpoints", std::move(checkpoints)},
          {"filled", filler_ != nullptr && filler_->is_done()},
          {"hashes", recording_->hashes.size()},
          {"diverged", divergence_ ? *divergence_ : Json()},
          {"people", describe_people(core)}};
}

}  // namespace vat
