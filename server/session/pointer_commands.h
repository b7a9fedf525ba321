#pragma once

#include <vector>

#include "server/clients/pending_reply.h"
#include "server/session/core/session_command.h"

namespace vat {

/// Commands that follow a pointer, such as grab.move, and wait for the next tick. If a participant
/// sends several commands for one target, only the latest command is executed. All commands are
/// answered.
class PointerCommands {
 public:
  struct Latest {
    ParticipantNumber participant = 0;
    SessionCommand command;
    std::vector<PendingReply> replies;  ///< includes replies of replaced commands
  };

  void add(ParticipantNumber participant, SessionCommand command, PendingReply reply);
  bool empty() const { return waiting_.empty(); }
  bool has_of(ParticipantNumber participant) const;
  /// Removes and returns all waiting commands in order.
  std::vector<Latest> take();

 private:
  std::vector<Latest> waiting_;
};

}  // namespace vat
