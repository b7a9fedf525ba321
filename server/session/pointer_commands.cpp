#include "server/session/pointer_commands.h"

#include <algorithm>
#include <utility>
#include "core/support/check.h"

namespace vat {
namespace {

/// Returns the target of a command: the grab, the body, or none.
Json subject_of(const SessionCommand& command) {
  for (const char* name : {"grab", "body"}) {
    const auto subject = command.params.find(name);
    if (subject != command.params.end()) return *subject;
  }
  return {};
}

}  // namespace

void PointerCommands::add(ParticipantNumber participant, SessionCommand command,
                          PendingReply reply) {
  VAT_CHECK(command.row != nullptr);
  const Json subject = subject_of(command);
  Latest latest{participant, std::move(command), {}};
  const auto before = std::ranges::find_if(waiting_, [&](const Latest& other) {
    return other.participant == participant && other.command.row == latest.command.row &&
           subject_of(other.command) == subject;
  });
  if (before != waiting_.end()) {
    latest.replies = std::move(before->replies);
    waiting_.erase(before);  // not replaced: later commands may wait already
  }
  latest.replies.push_back(std::move(reply));
  waiting_.push_back(std::move(latest));
}

bool PointerCommands::has_of(ParticipantNumber participant) const {
  return std::ranges::find(waiting_, participant, &Latest::participant) != waiting_.end();
}

std::vector<PointerCommands::Latest> PointerCommands::take() {
  return std::exchange(waiting_, {});
}

}  // namespace vat
