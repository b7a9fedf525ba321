#include "server/replay/replay_player.h"

#include <algorithm>
#include <iterator>
#include <string>
#include <tuple>
#include <utility>

#include "server/session/describe.h"
#include "server/session/scene_loading.h"
#include "server/storage/compression.h"

namespace vat {
namespace {

constexpr std::size_t kMaxStateBytes = std::size_t{1} << 30;  // of what a checkpoint may hold

[[noreturn]] void fail(const std::string& what, const std::string& why) {
  throw StorageError(StorageError::Kind::corrupt, "the recording's " + what + ": " + why);
}

auto key_of(const RecordedHash& hash) {
  return std::tuple(hash.position, hash.sequence);
}

/// Who follows along decides by themselves how fast that is.
bool is_of_the_clock(const LogEntry& entry) {
  return entry.method == "control.play" || entry.method == "control.pause" ||
         entry.method == "control.step" || entry.method == "control.set_speed";
}

}  // namespace

ReplayPlayer::ReplayPlayer(const Recording& recording, const SessionEnvironment& environment)
    : recording_(recording), environment_(environment), hashes_(recording.hashes) {}

void ReplayPlayer::compare_moments() {
  for (const RecordedMoment& moment : recording_.moments) {
    hashes_.push_back({moment.position, moment.sequence, load_state(moment).state_hash()});
  }
  std::ranges::stable_sort(hashes_, {}, key_of);
}

Simulation ReplayPlayer::load_state(const RecordedMoment& moment) const {
  Result<Simulation> simulation = Simulation::load(decompress(moment.state, kMaxStateBytes),
                                                   &environment_.runner, recording_.instructions);
  if (!simulation) fail("state", simulation.errors().front().message);
  return std::move(simulation).value();
}

Simulation ReplayPlayer::load_scene(std::uint64_t sequence) const {
  const auto entry = std::ranges::find(recording_.log, sequence, &LogEntry::sequence);
  if (entry == recording_.log.end()) fail("scene", "its entry is not there");
  const Result<Json> params =
      parse_json(entry->params, {entry->params.size(), kMaxMessageDepth, entry->params.size() + 1});
  if (!params) fail("scene", params.errors().front().message);
  const auto value = params.value().find("scene");
  if (value == params.value().end()) fail("scene", "its entry has none");
  const auto scene = read_client_scene(*value, environment_.catalogue);
  if (const auto* error = std::get_if<RpcError>(&scene)) fail("scene", error->message);
  auto simulation = make_simulation(std::get<Scene>(scene), environment_, recording_.instructions);
  if (const auto* error = std::get_if<RpcError>(&simulation)) fail("scene", error->message);
  return std::get<Simulation>(std::move(simulation));
}

Simulation ReplayPlayer::begin() const {
  if (const Status available = check_available(recording_.instructions); !available) {
    throw StorageError(StorageError::Kind::failed, available.errors().front().message);
  }
  return load_scene(recording_.log.front().sequence);
}

void ReplayPlayer::go_to_begin(SessionCore& core) {
  if (!recording_.is_whole()) return go_to(core, recording_.moments.front());
  Simulation simulation = load_scene(recording_.log.front().sequence);
  const Snapshot as_loaded = simulation.snapshot();
  const LogEntry& first = recording_.log.front();
  const SessionMoment moment{.position = recording_.begin,
                             .sequence = first.sequence,
                             .loaded = first.sequence,
                             .participants = write_participants(Participants()),
                             .snapshot = as_loaded};
  core.resume(moment, std::move(simulation), as_loaded);
  find_place(core);
}

void ReplayPlayer::go_to(SessionCore& core, const RecordedMoment& moment) {
  Simulation simulation = load_state(moment);
  const SessionMoment read = read_moment(moment.fields, simulation.snapshot());
  if (read.position != moment.position || read.sequence != moment.sequence) {
    fail("moment", "it tells of another place than its own");
  }
  const Snapshot as_loaded = load_scene(read.loaded).snapshot();
  core.resume(read, std::move(simulation), as_loaded);
  find_place(core);
}

void ReplayPlayer::find_place(const SessionCore& core) {
  const std::uint64_t sequence = core.sequence();
  const auto entry = std::ranges::upper_bound(recording_.log, sequence, {}, &LogEntry::sequence);
  next_entry_ = static_cast<std::size_t>(entry - recording_.log.begin());
  const auto hash =
      std::ranges::lower_bound(hashes_, std::tuple(core.run().position(), sequence), {}, key_of);
  next_hash_ = static_cast<std::size_t>(hash - hashes_.begin());
  same_until_ = core.run().tick();
  work_ = work_.zero();
}

void ReplayPlayer::carry_out_here(SessionCore& core) {
  for (; next_entry_ < recording_.log.size(); ++next_entry_) {
    compare_here(core);
    const LogEntry& entry = recording_.log[next_entry_];
    if (entry.position != core.run().position()) return;
    if (is_of_the_clock(entry)) {
      core.apply(entry, [](SessionCore&, Participant&) -> ActionResult { return Json::object(); });
    } else {
      carry_out_again(core, entry);
    }
  }
  compare_here(core);
}

void ReplayPlayer::compare_here(const SessionCore& core) {
  const auto here = std::tuple(core.run().position(), core.sequence());
  for (; next_hash_ < hashes_.size() && key_of(hashes_[next_hash_]) <= here; ++next_hash_) {
    const RecordedHash& expected = hashes_[next_hash_];
    if (key_of(expected) < here) continue;  // there is no such place
    const std::uint64_t hash = core.run().simulation().state_hash();
    if (hash != expected.hash) {
      throw Diverged("at tick " + std::to_string(core.run().tick()) + " the state has the hash " +
                     describe_hash(hash) + ", and was recorded with " +
                     describe_hash(expected.hash) + "; it was the same up to tick " +
                     std::to_string(same_until_));
    }
    same_until_ = core.run().tick();
    if (on_same) on_same(expected);
  }
}

const RecordedMoment* ReplayPlayer::find_moment(std::uint64_t position) const {
  const auto after =
      std::ranges::upper_bound(recording_.moments, position, {}, &RecordedMoment::position);
  const RecordedMoment* found = after == recording_.moments.begin() ? nullptr : &*(after - 1);
  const auto kept = kept_.upper_bound(position);
  if (kept == kept_.begin()) return found;
  const RecordedMoment& last = std::prev(kept)->second;
  return found == nullptr || found->position < last.position ? &last : found;
}

void ReplayPlayer::keep(const SessionCore& core) {
  const SessionMoment moment = core.moment();
  RecordedMoment kept{moment.position, moment.sequence, moment.fields(),
                      compress(moment.snapshot.to_bytes())};
  kept_bytes_ += kept.state.size() + kept.fields.size();
  kept_.emplace(moment.position, std::move(kept));
  while (kept_bytes_ > keeping_.most_bytes && !kept_.empty()) thin();
}

void ReplayPlayer::thin() {
  keeping_.work *= 2;
  bool goes = true;
  std::erase_if(kept_, [&](const auto& entry) {
    if (goes) kept_bytes_ -= entry.second.state.size() + entry.second.fields.size();
    return std::exchange(goes, !goes);
  });
}

void ReplayPlayer::play_to(SessionCore& core, std::uint64_t position,
                           const std::atomic<bool>& cancelled) {
  carry_out_here(core);
  while (core.run().position() < std::min(position, recording_.end)) {
    const auto begin = SteadyClock::now();
    run_to(core, core.run().position() + 1, cancelled);
    carry_out_here(core);
    work_ += SteadyClock::now() - begin;
    const RecordedMoment* last = find_moment(core.run().position());
    const bool is_there = last != nullptr && last->position == core.run().position();
    if (!is_there && work_ < keeping_.work) continue;
    if (!is_there) keep(core);
    work_ = work_.zero();
  }
}

void ReplayPlayer::seek(SessionCore& core, std::uint64_t position,
                        const std::atomic<bool>& cancelled) {
  position = std::clamp(position, recording_.begin, recording_.end);
  const RecordedMoment* from = find_moment(position);
  const std::uint64_t present = core.run().position();
  const bool goes_on = present <= position && (from == nullptr || from->position <= present);
  if (!goes_on && from == nullptr) {
    go_to_begin(core);
  } else if (!goes_on) {
    go_to(core, *from);
  }
  play_to(core, position, cancelled);
}

}  // namespace vat
