#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "server/clients/client_outbox.h"
#include "server/frames/frame_pace.h"
#include "server/frames/frame_source.h"
#include "server/frames/subscription.h"

namespace vat {

/// Distributor of a session's frames to the viewers. A viewer that is not ready for a due frame
/// receives a newer frame as soon as it is ready. Viewers with equal selections and reference
/// frames form a group and share one encoding. At most kMaxFrameGroups groups are encoded per
/// state. The viewers of the other groups receive the next state. A paused session may have no next
/// state, and serve_rest() serves them. Not thread-safe.
class FrameDelivery {
 public:
  FrameDelivery(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// Adds a subscription, or replaces the client's subscription. The client receives the next state
  /// regardless of its period.
  void add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription,
           Subscription subscribed);
  void remove(ConnectionId client);
  /// Sends a key frame to a client that could not decode the frame `number`. Ignores frames before
  /// the last key frame, because the client drops them. publish() or retry() sends the key frame.
  void restart(ConnectionId client, std::uint32_t number);
  /// Sets the vat of later states after a scene change or a reset.
  void set_vat(const std::optional<Vat>& vat);
  /// Sets the position error [m] for subscriptions without `max_error`. The initial value 0 selects
  /// the finest grid.
  void set_default_error(double max_error) { default_error_ = max_error; }

  /// Sends a new state to the viewers with a due frame. Exchanges `state` for an older state, so
  /// that the caller can reuse memory.
  void publish(PublishedState& state, SteadyClock::time_point now);
  /// Sends the last state to clients that may have become ready.
  void retry(std::span<const ConnectionId> clients, SteadyClock::time_point now);
  /// Whether viewers of a paused session wait for the last state only because of kMaxFrameGroups.
  bool has_rest() const { return !rest_.empty(); }
  /// Encodes the last state for at most kMaxFrameGroups of the groups that has_rest() reports.
  void serve_rest(SteadyClock::time_point now);

 private:
  struct Viewer {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription = 0;
    Subscription subscribed;
    FramePace pace;
    bool awaits_any = true;   ///< a frame is due even without new content
    bool has_turn = false;    ///< the last state was due for the viewer
    bool owes_frame = false;  ///< a state was due, and no frame was sent afterwards
    HeldFrames held;
    std::uint32_t key_number = 0;  ///< number of the last frame that was sent without references
    std::uint32_t shown = 0;       ///< number of the last state that the viewer shows
    std::uint64_t sent_tick = 0;   ///< tick of the last sent frame
    std::size_t passed_over = 0;   ///< consecutive states in which its group was not encoded

    std::uint64_t period() const { return subscribed.every * pace.stride(); }  ///< [ticks]
  };
  /// All properties of a viewer that determine the bytes of its frame.
  struct GroupKey {
    FrameCut cut;
    std::uint8_t stride = 1;
    bool awaits_any = false;
    const GridFrame* first = nullptr;
    const GridFrame* second = nullptr;
    // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 reports a zero in the default
    auto operator<=>(const GroupKey&) const = default;
  };
  struct EncodedFrame {
    std::shared_ptr<const GridFrame> frame;
    SharedFrame bytes;  // null: the frame has no new content
  };
  using Groups = std::map<GroupKey, std::vector<Viewer*>>;

  void note_turns(const PublishedState& state);
  bool turn_has_come(const Viewer& viewer, const PublishedState& state) const;
  void gather(Viewer& viewer, SteadyClock::time_point now, Groups& groups);
  void serve(const Groups& groups, SteadyClock::time_point now);
  const EncodedFrame* encode(const GroupKey& key, const HeldFrames& held);
  /// Returns whether a frame was sent.
  bool send(Viewer& viewer, const EncodedFrame& encoded, SteadyClock::time_point now);

  ServerMetrics& metrics_;
  std::map<ConnectionId, Viewer> viewers_;
  FrameSource source_;
  std::map<GroupKey, EncodedFrame> encoded_;  // frames of the last state
  double default_error_ = 0;
  std::uint8_t least_detail_ = kFullDetail;
  std::vector<ConnectionId> rest_;  // see has_rest()
  bool has_state_ = false;
  bool is_playing_ = false;  // in the last state
  std::uint64_t tick_ = 0;   // tick of the last state
  std::uint32_t epoch_ = 0;  // epoch of the last state
};

}  // namespace vat
