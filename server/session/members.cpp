#include "server/session/members.h"

#include <algorithm>
#include <utility>

namespace vat {

Member* Members::find(ConnectionId id) {
  const auto found = members_.find(id);
  return found == members_.end() ? nullptr : &found->second;
}

Member& Members::add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t membership) {
  const ConnectionId id = outbox->id();
  Member member;
  member.outbox = std::move(outbox);
  member.membership = membership;
  return members_[id] = std::move(member);
}

void Members::remove(ConnectionId id) {
  members_.erase(id);
}

Member* Members::holder_of(std::uint64_t grab) {
  for (auto& [id, member] : members_) {
    if (member.grabs.contains(grab)) return &member;
  }
  return nullptr;
}

void Members::send_event(const std::string& text) {
  for (auto& [id, member] : members_) member.outbox->send_event(member.membership, text);
}

void Members::start_epoch(std::uint32_t epoch) {
  for (auto& [id, member] : members_) member.outbox->start_epoch(member.membership, epoch);
}

bool Members::is_watched(std::uint64_t tick) const {
  return std::ranges::any_of(members_, [&](const auto& entry) {
    const auto& subscription = entry.second.subscription;
    return subscription && tick % subscription->every == 0;
  });
}

bool Members::is_watched() const {
  return std::ranges::any_of(
      members_, [](const auto& entry) { return entry.second.subscription.has_value(); });
}

ByAttribute<bool> Members::wanted_attributes() const {
  ByAttribute<bool> wanted{};
  for (const auto& [id, member] : members_) {
    if (!member.subscription) continue;
    for (std::size_t a = 0; a < kFrameAttributes; ++a) {
      wanted[a] |= member.subscription->attribute_errors[a] > 0;
    }
  }
  return wanted;
}

void Members::close_silent(SteadyClock::time_point now, std::chrono::seconds patience) {
  for (auto& [id, member] : members_) member.outbox->close_if_silent(now, patience);
}

void Members::forget_grabs() {
  for (auto& [id, member] : members_) member.grabs.clear();
}

void Members::forget_grab(std::uint64_t grab) {
  for (auto& [id, member] : members_) member.grabs.erase(grab);
}

void Members::forget_grabs_of(BodyId body) {
  for (auto& [id, member] : members_) {
    std::erase_if(member.grabs, [&](const auto& grab) { return grab.second == body; });
  }
}

}  // namespace vat
