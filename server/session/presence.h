#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"
#include "server/session/participants.h"

namespace vat {

/// What the participants of a session are told of each other: whoever comes, goes or changes, some
/// times a second at most, however often that is. Used by one thread at a time.
class Presence {
 public:
  static constexpr std::chrono::milliseconds kInterval{100};

  /// The participants have changed, maybe.
  void touch() { is_touched_ = true; }
  bool is_touched() const { return is_touched_; }
  /// Before this there is nothing to tell.
  SteadyClock::time_point due() const { return told_at_ + kInterval; }
  /// The params of presence.changed, and takes them as told; null where nothing has changed.
  Json take_changes(const Participants& participants, SteadyClock::time_point now);

 private:
  /// What is told of one.
  struct Seen {
    std::string name;
    Role role = Role::none;
    bool is_away = false;
    std::vector<BodyId> grabs;
    std::optional<Pointer> pointer;
    bool operator==(const Seen&) const = default;
  };
  static Seen look(const Participant& participant);

  std::map<ParticipantNumber, Seen> told_;
  SteadyClock::time_point told_at_{};
  bool is_touched_ = false;
};

/// One that others are told of.
Json describe_participant(const Participant& participant);
/// Those who came first, as many as are told of.
Json describe_participants(const Participants& participants);

}  // namespace vat
