#include "server/session/replay_run.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <exception>
#include <optional>
#include <utility>

#include "protocol/json/printable.h"
#include "server/replay/foreign_text.h"
#include "server/session/describe.h"
#include "server/session/person_name.h"
#include "server/session/saved_state.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

constexpr std::size_t kMaxReason = 1000;  // bytes
constexpr auto kPeopleInterval = std::chrono::milliseconds(100);
constexpr KeptMoments::Seconds kWork{
    0.04};  // between two moments, of a seek of a fifth of a second
constexpr std::size_t kMaxMomentBytes = std::size_t{128}
                                        << 20;  // of moments beside the recording's own

/// Pointers are not recorded, but where those who hold something draw it.
Json describe_hand(const SessionCore& core, const Participant& person) {
  if (person.grabs.empty()) return nullptr;
  const std::optional<Vec3> target =
      core.run().simulation().grab_target(person.grabs.rbegin()->first);
  return target ? Json{{"position", to_json(*target)}} : Json();
}

}  // namespace

ReplayRun::ReplayRun(std::shared_ptr<const Recording> recording,
                     const SessionEnvironment& environment)
    : recording_(std::move(recording)),
      environment_(environment),
      moments_(std::make_shared<KeptMoments>(kWork, kMaxMomentBytes)),
      player_(*recording_, environment_) {
  player_.share(moments_);
  read_names();
}

/// Who joins is not in the log; checkpoints have the names.
void ReplayRun::read_names() {
  for (const RecordedMoment& moment : recording_->moments) {
    const Result<Json> fields = parse_json(moment.fields, {moment.fields.size(), 16, 100'000});
    if (!fields || !fields.value().is_object()) continue;
    Participants people;
    try {
      read_participants(fields.value().value("participants", Json()), people);
    } catch (const StorageError&) {
      continue;  // who goes there is told
    }
    for (const auto& [number, person] : people.all()) {
      names_[number] = is_showable_name(person.name) ? person.name : printable(person.name);
    }
  }
}

template <class Action>
bool ReplayRun::in_the_past(SessionCore& core, Action&& action) {
  const bool playing = core.playing();
  const double speed = core.speed();
  std::string difference;
  {
    const SessionCore::RecordedParticipants recorded(core);
    try {
      action();
    } catch (const Diverged& error) {
      difference = error.what();
    } catch (const StorageError& error) {
      difference = error.what();
    }
  }
  core.set_clock(playing, speed);
  if (difference.empty()) return true;
  differ(core, difference);
  return false;
}

void ReplayRun::differ(SessionCore& core, const std::string& reason) {
  spdlog::warn("session {}: the recording differs: {}", core.id(), reason);
  player_.stop_comparing();
  core.set_playing(false);
  differs_ = Json{{"position", core.run().position()},
                  {"tick", core.run().tick()},
                  {"reason", fit_to_tell(reason, kMaxReason)}};
  core.participants().send_event(write_event("replay.diverged", *differs_));
}

void ReplayRun::start(SessionCore& core) {
  core.show(this);
  in_the_past(core, [&] { player_.go_to_begin(core); });
  core.set_clock(false, 1);
  core.begin_epoch(epoch_);
  filler_ = std::make_unique<MomentFiller>(recording_, environment_, moments_);
}

bool ReplayRun::tick(SessionCore& core, SteadyClock::time_point now, bool timed) {
  const std::uint64_t before = core.run().position();
  const bool same = in_the_past(
      core, [&] { player_.play_to(core, std::min(before + 1, recording_->end), cancelled_); });
  epoch_ = core.run().epoch();
  const bool has_run = core.run().position() > before;
  if (has_run && timed) core.time_tick(now);
  if (same && core.run().position() >= recording_->end) {
    core.set_playing(false);
    core.participants().send_event(write_event(
        "replay.ended", {{"position", core.run().position()}, {"tick", core.run().tick()}}));
  }
  return has_run;
}

void ReplayRun::begin_seek(SessionCore& core, std::uint64_t position) {
  differs_.reset();
  target_ = std::clamp(position, recording_->begin, recording_->end);
  if (!in_the_past(core, [&] { player_.begin_seek(core, target_); })) target_ = 0;
}

bool ReplayRun::seek_on(SessionCore& core, CostClock::time_point until) {
  bool same = true;
  const auto is_there = [&] { return !same || core.run().position() >= target_; };
  if (target_ == core.run().position()) {
    same = in_the_past(core, [&] { player_.play_to(core, target_, cancelled_); });
  }
  while (!is_there() && CostClock::now() < until) {
    same = in_the_past(core, [&] { player_.play_to(core, core.run().position() + 1, cancelled_); });
  }
  return is_there();
}

void ReplayRun::end_seek(SessionCore& core) {
  core.begin_epoch(++epoch_);
}

std::optional<std::uint64_t> ReplayRun::find_tick(const SessionCore& core,
                                                  std::uint64_t tick) const {
  const std::uint64_t run_begin = core.run().position() - core.run().tick();
  const std::uint64_t wanted = run_begin + tick;
  if (wanted < recording_->begin || wanted > recording_->end) return {};
  const bool run_ends = std::ranges::any_of(recording_->log, [&](const LogEntry& entry) {
    return entry.sequence > core.sequence() && entry.position <= wanted && !entry.refused &&
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
          {"playing", core.playing()},
          {"speed", core.speed()},
          {"checkpoints", std::move(checkpoints)},
          {"filled", filler_ != nullptr && filler_->is_done()},
          {"hashes", recording_->hashes.size()},
          {"diverged", differs_ ? *differs_ : Json()},
          {"people", describe_people(core)}};
}

}  // namespace vat
