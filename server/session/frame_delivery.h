#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "server/session/client_outbox.h"
#include "server/session/frame_source.h"
#include "server/session/subscription.h"

namespace vat {

/// Which viewer of a session gets which frame. Every viewer owes its frames to the states that are
/// published: one whose turn it is gets the frame at once or, where it is not ready, a newer one as
/// soon as it is. Used by one thread at a time.
class FrameDelivery {
 public:
  FrameDelivery(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// Replaces an earlier subscription of the client; the next state is for it, whatever `every` is.
  void add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription, Subscription wish);
  void remove(ConnectionId client);
  /// The states from here on are of another scene, or of the same from its start.
  void set_vat(const std::optional<Vat>& vat);

  /// A further state: goes to those whose turn it is and to those who have missed theirs.
  void publish(PublishedState state);
  /// These may have become ready.
  void retry(std::span<const ConnectionId> clients);

 private:
  struct Viewer {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription = 0;
    Subscription wish;
    bool awaits_any = true;  ///< also a frame that shows nothing new
    bool is_owed = false;    ///< its turn has come, and it has got nothing since
    std::uint64_t shown = 0;
  };
  void note_turns(const PublishedState& state);
  void serve(Viewer& viewer);

  FrameSource source_;
  std::map<ConnectionId, Viewer> viewers_;
  bool has_state_ = false;
  std::uint64_t tick_ = 0;   // of the last state
  std::uint32_t epoch_ = 0;  // the same
};

}  // namespace vat
