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

/// Queue of requests that the session's strand has not executed yet. Thread-safe.
class SessionInbox {
 public:
  struct Join {
    std::uint64_t membership;
    JoinRequest request;
    std::function<void()> undo;  ///< called before a join is refused
  };
  struct Leave {};
  struct Disconnect {};
  /// The relay of another node wants frames, see SessionNotifier::watch().
  struct Watch {
    Subscription wanted;
  };
  struct Unwatch {};
  struct Item {
    PendingReply reply;
    std::variant<Join, Leave, Disconnect, Watch, Unwatch, SessionCommand> task;
  };

  enum class Added {
    to_pending,  ///< a turn is already scheduled
    first,       ///< the caller must schedule a turn
    refused      ///< the inbox is closed; the item is unchanged
  };
  Added add(Item& item);
  /// Removes and returns the first item. If the queue is empty, the next add() returns
  /// Added::first, and its caller must schedule a turn of the strand. Further turns do no harm.
  std::optional<Item> take();
  /// Closes the inbox and returns the remaining items. A closed inbox refuses new items.
  std::deque<Item> close();

 private:
  std::mutex mutex_;
  std::deque<Item> items_;
  bool turn_scheduled_ = false;
  bool is_closed_ = false;
};

}  // namespace vat
