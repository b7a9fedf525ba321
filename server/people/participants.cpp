#include "server/people/participants.h"

#include <algorithm>
#include <utility>
#include "core/support/check.h"

namespace vat {

std::size_t Participants::away() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(all_, [](const auto& entry) { return entry.second.is_away(); }));
}

Participant* Participants::find(ParticipantNumber number) {
  const auto found = all_.find(number);
  return found == all_.end() ? nullptr : &found->second;
}

Participant* Participants::find_client(ConnectionId client) {
  const auto found = by_client_.find(client);
  return found == by_client_.end() ? nullptr : &all_.at(found->second);
}

Participant* Participants::find_resume(const TokenHash& token) {
  const auto found = std::ranges::find_if(all_, [&](const auto& entry) {
    return entry.second.resume && are_same(*entry.second.resume, token);
  });
  return found == all_.end() ? nullptr : &found->second;
}

Participant* Participants::holder_of(std::uint64_t grab) {
  for (auto& [number, participant] : all_) {
    if (participant.grabs.contains(grab)) return &participant;
  }
  return nullptr;
}

const Participant* Participants::holder_of_body(BodyId body) const {
  for (const auto& [number, participant] : all_) {
    for (const auto& [grab, held] : participant.grabs) {
      if (held == body) return &participant;
    }
  }
  return nullptr;
}

Participant& Participants::add(std::string name, Role role) {
  VAT_CHECK(role > Role::none);
  touch();
  Participant& added = all_[++last_number_];
  added.number = last_number_;
  added.name = std::move(name);
  added.role = role;
  return added;
}

void Participants::set_role(Participant& participant, Role role) {
  touch();
  participant.role = role;
  if (participant.is_here()) participant.outbox->set_role(participant.membership, role);
}

Participant& Participants::find_or_add(ParticipantNumber number) {
  Participant& ghost = all_[number];
  ghost.number = number;
  last_number_ = std::max(last_number_, number);
  return ghost;
}

void Participants::remove(ParticipantNumber number) {
  touch();
  if (Participant* participant = find(number)) disconnect(*participant);
  all_.erase(number);
}

void Participants::connect(Participant& participant, std::shared_ptr<ClientOutbox> outbox,
                           std::uint64_t membership) {
  VAT_CHECK(outbox != nullptr);
  touch();
  disconnect(participant);
  by_client_[outbox->id()] = participant.number;
  participant.outbox = std::move(outbox);
  participant.membership = membership;
  participant.away_since.reset();
  participant.outbox->set_role(membership, participant.role);
}

void Participants::disconnect(Participant& participant) {
  if (!participant.is_here()) return;
  touch();
  by_client_.erase(participant.outbox->id());
  participant.outbox.reset();
  participant.pointer.reset();
}

void Participants::send_away(SteadyClock::time_point now) {
  for (auto& [number, participant] : all_) {
    if (participant.is_here()) continue;
    participant.away_since = now;
    participant.pointer.reset();
  }
}

void Participants::send_event(std::string text, Role least) {
  const auto shared = std::make_shared<const std::string>(std::move(text));
  for (auto& [number, participant] : all_) {
    if (!participant.is_here() || participant.role < least) continue;
    participant.outbox->send_event(participant.membership, shared);
  }
}

void Participants::start_epoch(std::uint32_t epoch) {
  for (auto& [number, participant] : all_) {
    if (participant.is_here()) participant.outbox->start_epoch(participant.membership, epoch);
  }
}

bool Participants::is_watched(std::uint64_t tick) const {
  return std::ranges::any_of(all_, [&](const auto& entry) {
    const auto& subscription = entry.second.subscription;
    return entry.second.is_here() && subscription && tick % subscription->every == 0;
  });
}

bool Participants::is_watched() const {
  return std::ranges::any_of(all_, [](const auto& entry) {
    return entry.second.is_here() && entry.second.subscription.has_value();
  });
}

ByAttribute<bool> Participants::wanted_attributes() const {
  ByAttribute<bool> wanted{};
  for (const auto& [number, participant] : all_) {
    if (!participant.is_here() || !participant.subscription) continue;
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      wanted[a] |= participant.subscription->attribute_errors[a] > 0;
    }
  }
  return wanted;
}

void Participants::close_silent(SteadyClock::time_point now, std::chrono::seconds patience) {
  for (auto& [number, participant] : all_) {
    if (participant.is_here()) participant.outbox->close_if_silent(now, patience);
  }
}

void Participants::forget_grabs() {
  for (auto& [number, participant] : all_) {
    participant.grabs.clear();
    participant.grab_uses.clear();
  }
}

void Participants::forget_grab(std::uint64_t grab) {
  for (auto& [number, participant] : all_) {
    participant.grabs.erase(grab);
    participant.grab_uses.erase(grab);
  }
}

void Participants::forget_grabs_of(BodyId body) {
  for (auto& numbered : all_) {
    Participant& participant = numbered.second;
    std::erase_if(participant.grabs, [&](const auto& grab) { return grab.second == body; });
    std::erase_if(participant.grab_uses,
                  [&](const auto& use) { return !participant.grabs.contains(use.first); });
  }
}

}  // namespace vat
