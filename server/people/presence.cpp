#include "server/people/presence.h"

#include <algorithm>
#include <utility>

#include "server/messages/limits.h"

namespace vat {
namespace {

/// Each once, in ascending order.
std::vector<BodyId> held_bodies(const Participant& participant) {
  std::vector<BodyId> bodies;
  for (const auto& [grab, body] : participant.grabs) bodies.push_back(body);
  std::ranges::sort(bodies);
  bodies.erase(std::unique(bodies.begin(), bodies.end()), bodies.end());
  return bodies;
}

Json describe_pointer(const std::optional<Pointer>& pointer) {
  if (!pointer) return nullptr;
  Json told{{"position", to_json(pointer->position)}};
  if (pointer->direction) told["direction"] = to_json(*pointer->direction);
  return told;
}

}  // namespace

Json describe_participant(const Participant& participant) {
  return {
      {"participant", participant.number},   {"name", participant.name},
      {"role", to_string(participant.role)}, {"away", participant.is_away()},
      {"grabs", held_bodies(participant)},   {"pointer", describe_pointer(participant.pointer)}};
}

Json describe_participants(const Participants& participants) {
  Json list = Json::array();
  for (const auto& [number, participant] : participants.all()) {
    if (list.size() == kMaxPresence) break;
    if (!participant.is_placeholder()) list.push_back(describe_participant(participant));
  }
  return list;
}

Presence::PublishedParticipant Presence::publish(const Participant& participant) {
  return {participant.name, participant.role, participant.is_away(), held_bodies(participant),
          participant.pointer};
}

Json Presence::take_changes(const Participants& participants, SteadyClock::time_point now) {
  told_at_ = now;
  is_touched_ = false;
  Json left = Json::array();
  for (auto told = told_.begin(); told != told_.end();) {
    if (participants.all().contains(told->first)) {
      ++told;
    } else {
      left.push_back(told->first);
      told = told_.erase(told);
    }
  }
  Json changed = Json::array();
  for (const auto& [number, participant] : participants.all()) {
    if (participant.is_placeholder()) continue;
    const auto told = told_.find(number);
    if (told == told_.end() && told_.size() >= kMaxPresence) continue;
    PublishedParticipant current = publish(participant);
    if (told != told_.end() && told->second == current) continue;
    changed.push_back(describe_participant(participant));
    told_.insert_or_assign(number, std::move(current));
  }
  if (left.empty() && changed.empty()) return nullptr;
  return {{"participants", std::move(changed)}, {"left", std::move(left)}};
}

}  // namespace vat
