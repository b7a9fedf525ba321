#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <vector>

#include "server/session/client_outbox.h"
#include "server/session/frame_pace.h"
#include "server/session/frame_source.h"
#include "server/session/subscription.h"

namespace vat {

/// Which viewer of a session gets which frame. Who is due a frame gets it at once or, where it is
/// not ready, a newer one as soon as it is. Viewers who are shown the same and hold the same frames
/// are a group and share one encoding; of one state no more than kMaxFrameGroups are made, and who
/// is passed over is due the next one. Used by one thread at a time.
class FrameDelivery {
 public:
  FrameDelivery(const std::optional<Vat>& vat, ServerMetrics& metrics);

  /// Replaces an earlier subscription of the client; the next state is for it, whatever `every` is.
  void add(std::shared_ptr<ClientOutbox> outbox, std::uint64_t subscription, Subscription wish);
  void remove(ConnectionId client);
  /// The states from here on are of another scene, or of the same from its start.
  void set_vat(const std::optional<Vat>& vat);
  /// [m] Of positions, for those who have asked for none; 0, as at first: the finest grid.
  void set_default_error(double max_error) { default_error_ = max_error; }

  /// A further state: goes to those whose turn it is and to those who have missed theirs. Leaves an
  /// older one in its place.
  void publish(PublishedState& state, SteadyClock::time_point now);
  /// These may have become ready.
  void retry(std::span<const ConnectionId> clients, SteadyClock::time_point now);

 private:
  struct Viewer {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t subscription = 0;
    Subscription wish;
    FramePace pace;
    bool awaits_any = true;  ///< also a frame that shows nothing new
    bool has_turn = false;   ///< with the last state
    bool is_due = false;     ///< has had its turn, and got nothing since
    HeldFrames held;
    std::uint32_t shown = 0;      ///< number as of which it has seen all that there is
    std::uint64_t sent_tick = 0;  ///< of the last frame
    std::size_t passed_over = 0;  ///< times in a row

    std::uint64_t period() const { return wish.every * pace.stride(); }  ///< [ticks]
  };
  /// What the viewers of a group have in common: all that their frame's bytes depend on.
  struct GroupKey {
    FrameCut cut;
    std::uint8_t stride = 1;
    bool awaits_any = false;
    const GridFrame* first = nullptr;
    const GridFrame* second = nullptr;
    // NOLINTNEXTLINE(modernize-use-nullptr): a zero that clang-tidy 14 sees in what is not written
    auto operator<=>(const GroupKey&) const = default;
  };
  struct EncodedFrame {
    std::shared_ptr<const GridFrame> frame;
    SharedFrame bytes;  // null: there is nothing new to see
  };
  using Groups = std::map<GroupKey, std::vector<Viewer*>>;

  void note_turns(const PublishedState& state);
  bool turn_has_come(const Viewer& viewer, const PublishedState& state) const;
  void gather(Viewer& viewer, SteadyClock::time_point now, Groups& groups);
  void serve(const Groups& groups, SteadyClock::time_point now);
  const EncodedFrame* make(const GroupKey& key, const HeldFrames& held);
  /// Whether it was sent.
  bool hand_over(Viewer& viewer, const EncodedFrame& made, SteadyClock::time_point now);

  ServerMetrics& metrics_;
  std::map<ConnectionId, Viewer> viewers_;
  FrameSource source_;
  std::map<GroupKey, EncodedFrame> made_;  // of the last state
  double default_error_ = 0;
  std::uint8_t least_detail_ = kFullDetail;
  bool has_state_ = false;
  std::uint64_t tick_ = 0;   // of the last state
  std::uint32_t epoch_ = 0;  // the same
};

}  // namespace vat
