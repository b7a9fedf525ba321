#pragma once

#include <cstddef>
#include <vector>

#include "server/session/pending_reply.h"
#include "server/session/session_core.h"

namespace vat {

/// Commands that follow a pointer, as they wait for the next tick. Of those that one participant
/// gives about one thing, the newest counts and is carried out for all: what comes many times a
/// tick costs as much as once.
class PointerCommands {
 public:
  struct Newest {
    ParticipantNumber participant = 0;
    SessionCommand command;
    std::vector<PendingReply> callers;  ///< of this one and of those whose place it took
  };

  void add(ParticipantNumber participant, SessionCommand command, PendingReply caller);
  bool empty() const { return waiting_.empty(); }
  bool has_of(ParticipantNumber participant) const;
  /// Those that have waited, in the order in which they came.
  std::vector<Newest> take();

 private:
  std::vector<Newest> waiting_;
};

}  // namespace vat
