#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "protocol/json/json_reader.h"
#include "server/people/participants.h"

namespace vat {

/// Collector of changes of a session's participants for the event presence.changed. The event is
/// sent at most ten times per second. Not thread-safe.
class Presence {
 public:
  static constexpr std::chrono::milliseconds kInterval{100};

  /// Marks the participants as possibly changed.
  void touch() { is_touched_ = true; }
  bool is_touched() const { return is_touched_; }
  /// Returns the earliest time of the next event.
  SteadyClock::time_point due() const { return told_at_ + kInterval; }
  /// Returns the parameters of presence.changed, or null if nothing has changed since the last
  /// call.
  Json take_changes(const Participants& participants, SteadyClock::time_point now);

 private:
  /// State of a participant in the last event.
  struct PublishedParticipant {
    std::string name;
    Role role = Role::none;
    bool is_away = false;
    std::vector<BodyId> grabs;
    std::optional<Pointer> pointer;
    bool operator==(const PublishedParticipant&) const = default;
  };
  static PublishedParticipant publish(const Participant& participant);

  std::map<ParticipantNumber, PublishedParticipant> told_;
  SteadyClock::time_point told_at_{};
  bool is_touched_ = false;
};

/// Returns a participant in the format of presence.list.
Json describe_participant(const Participant& participant);
/// Returns the first kMaxPresence participants.
Json describe_participants(const Participants& participants);

}  // namespace vat
