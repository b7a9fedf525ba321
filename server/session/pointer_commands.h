#pragma once

#include <vector>

#include "server/clients/pending_reply.h"
#include "server/session/core/session_command.h"

namespace vat {

/// Commands that follow a pointer and wait for the next tick. If a participant sends several for
/// one target, only the latest is executed, and all are answered.
class PointerCommands {
 public:
  struct Latest {
    ParticipantNumber participant = 0;
    SessionCommand command;
    std::vector<PendingReply> replies;  ///< also of the commands that it replaces
  };

  void add(ParticipantNumber participant, SessionCommand command, PendingReply reply);
  bool empty() const { return waiting_.empty(); }
  bool has_of(ParticipantNumber participant) const;
  /// Returns all waiting commands in order.
  std::vector<Latest> take();

 private:
  std::vector<Latest> waiting_;
};

}  // namespace vat
