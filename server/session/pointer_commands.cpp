#include "server/session/pointer_commands.h"

#include <algorithm>
#include <utility>

namespace vat {
namespace {

/// What a command is about: of those about the same thing the newest counts.
Json subject_of(const SessionCommand& command) {
  for (const char* name : {"grab", "body"}) {
    const auto subject = command.params.find(name);
    if (subject != command.params.end()) return *subject;
  }
  return {};
}

}  // namespace

void PointerCommands::add(ParticipantNumber participant, SessionCommand command,
                          PendingReply caller) {
  const Json subject = subject_of(command);
  Newest newest{participant, std::move(command), {}};
  const auto before = std::ranges::find_if(waiting_, [&](const Newest& other) {
    return other.participant == participant && other.command.rules == newest.command.rules &&
           subject_of(other.command) == subject;
  });
  if (before != waiting_.end()) {
    newest.callers = std::move(before->callers);
    waiting_.erase(before);  // and not in its place: others may have come since
  }
  newest.callers.push_back(std::move(caller));
  waiting_.push_back(std::move(newest));
}

bool PointerCommands::has_of(ParticipantNumber participant) const {
  return std::ranges::find(waiting_, participant, &Newest::participant) != waiting_.end();
}

std::vector<PointerCommands::Newest> PointerCommands::take() {
  return std::exchange(waiting_, {});
}

}  // namespace vat
