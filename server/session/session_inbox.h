#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <mutex>
#include <optional>
#include <variant>

#include "server/clients/pending_reply.h"
#include "server/session/core/session_command.h"
#include "server/session/core/session_people.h"

namespace vat {

/// Requests to a session that its strand has not executed yet, in their order. Safe to use from
/// any thread.
class SessionInbox {
 public:
  struct Join {
    std::uint64_t membership;
    JoinRequest request;
    std::function<void()> undo;  ///< called before a refusal is answered
  };
  struct Leave {};
  struct Disconnect {};
  struct Item {
    PendingReply reply;
    std::variant<Join, Leave, Disconnect, SessionCommand> task;
  };

  enum class Added {
    to_pending,  ///< a turn is scheduled already
    first,       ///< the caller has to schedule a turn
    refused      ///< the inbox is closed; the item is unchanged
  };
  Added add(Item& item);
  /// Returns the first item. If there is none, the next item that is added needs a turn.
  std::optional<Item> take();
  /// Refuses items from now on, and returns those that are left.
  std::deque<Item> close();

 private:
  std::mutex mutex_;
  std::deque<Item> items_;
  bool turn_scheduled_ = false;
  bool is_closed_ = false;
};

}  // namespace vat
