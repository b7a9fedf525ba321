#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "server/session/client_outbox.h"

namespace vat {

struct Subscription {
  double max_error = 0;     ///< [m]; 0: the finest grid
  std::uint64_t every = 1;  ///< [ticks]
};

/// A client in a session.
struct Member {
  std::shared_ptr<ClientOutbox> outbox;
  std::uint64_t membership = 0;
  std::optional<Subscription> subscription;
  bool awaits_frame = false;  ///< sends the present state at the next chance, whatever `every` is
  std::uint64_t shown = 0;    ///< what it was sent last, see FrameSource::content()
  std::map<std::uint64_t, BodyId> grabs;  ///< by the ids that the session gave
};

/// The clients of a session; used by one thread at a time.
class Members {
 public:
  std::size_t size() const { return members_.size(); }
  /// Null if it has not joined. Valid until the member leaves.
  Member* find(ConnectionId id);
  /// Replaces an earlier membership of the same client.
  Member& add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t membership);
  void remove(ConnectionId id);
  /// The member that has this grab, or null.
  Member* holder_of(std::uint64_t grab);

  void send_event(const std::string& text);
  /// Ends an epoch: frames that wait are dropped, and all subscribers await one of the new epoch.
  void start_epoch();
  void await_frames();
  void forget_grabs();
  void forget_grab(std::uint64_t grab);
  void forget_grabs_of(BodyId body);

  std::map<ConnectionId, Member>& all() { return members_; }

 private:
  std::map<ConnectionId, Member> members_;
};

}  // namespace vat
