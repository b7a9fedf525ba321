#include "server/session/members.h"

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

void Members::start_epoch() {
  for (auto& [id, member] : members_) member.outbox->drop_waiting(member.membership);
  await_frames();
}

void Members::await_frames() {
  for (auto& [id, member] : members_) member.awaits_frame = member.subscription.has_value();
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
