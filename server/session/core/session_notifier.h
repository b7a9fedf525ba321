#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "server/frames/frame_feed.h"
#include "server/people/presence.h"
#include "server/session/core/session_history.h"
#include "server/session/core/session_summary.h"

namespace vat {

/// Sender of a session's events, descriptions and frames. Commands only mark changes, and
/// announce() sends each marked item once. Several commands therefore cause only one description,
/// one status and one frame. Not thread-safe.
class SessionNotifier {
 public:
  /// `participants` receive the events. `recorded` are the participants of a replay's recording.
  SessionNotifier(const SessionContext& context, const SessionRun& run, const SessionClock& clock,
                  const SessionHistory& history, Participants& participants,
                  Participants& recorded);

  void mark_description() { description_due_ = true; }
  void mark_status() { status_due_ = true; }
  /// Marks the current state for publication, even without a tick.
  void mark_frame() { frame_due_ = true; }
  void mark_divergence() { divergence_due_ = true; }
  /// Drops the frames of earlier epochs. Marks description, status and frame.
  void start_epoch();
  /// Restarts the frames for another simulation, so that the frame grid covers its vat.
  void reset_frames();
  /// Discards velocities after bodies were moved without a tick. Accelerations are then unknown.
  void forget_velocities() { publisher_.forget(); }

  /// Sends frames to the participant from now on. The first frame contains the current state if the
  /// session is paused, and the state of the next tick otherwise. Clients that subscribe between
  /// two ticks therefore share a key frame.
  void subscribe(Participant& participant, const Subscription& subscription,
                 SteadyClock::time_point now);
  void unsubscribe(Participant& participant);
  void remove_viewer(ConnectionId client) { frames_->remove(client); }
  /// Sends frames to a viewer who is no participant, for the relay of another node. Facts about the
  /// frames precede the first frame of each epoch. The second call for a viewer changes the frames.
  void watch(const std::shared_ptr<ClientOutbox>& viewer, const Subscription& wanted,
             SteadyClock::time_point now);
  void unwatch(ConnectionId viewer);
  /// Closes the connections of all viewers of watch().
  void end_watchers();

  /// Stores the velocities before a tick if a client has requested accelerations.
  void prepare_tick();
  void tell_guard(const AdvanceReport& report);
  /// Tells that the CPU continues in place of a device.
  void tell_device(const Error& error);
  /// Sends a marked description after a tick. Publishes the state if a frame is due for a client.
  void publish_tick();
  /// Sends all marked items.
  void announce();
  void announce_status();
  Presence& presence() { return presence_; }
  /// Sends the event presence.changed if the participants have changed.
  void tell_presence(SteadyClock::time_point now);

  /// Text of a description in two parts. The long second part contains the bodies. It is constant
  /// within an epoch and written once.
  struct DescriptionText {
    std::string begin;
    SharedText end;  ///< also ends the result of session.join and its reply, by two braces
  };
  /// Returns the session's description for session.join and session.description.
  DescriptionText description();
  SessionSummary summary();
  /// Runs `task` on a frame thread, after the frames of all states that were published before.
  void post_behind_frames(std::function<void()> task) { frames_->post(std::move(task)); }

 private:
  Json status() const;
  /// Returns the description's members except `bodies`.
  Json describe_session() const;
  void tell_description();
  void tell_divergence();
  void publish_frame();
  void fill_state();
  void list_people();
  bool is_watched(std::optional<std::uint64_t> tick) const;
  ByAttribute<bool> wanted_attributes() const;
  void tell_facts(ClientOutbox& viewer, std::uint64_t membership);

  const SessionContext& context_;
  const SessionRun& run_;
  const SessionClock& clock_;
  const SessionHistory& history_;
  Participants& participants_;
  Participants& recorded_;
  const std::shared_ptr<FrameFeed> frames_;
  StatePublisher publisher_;
  PublishedState state_;  // next state, or memory of an older state
  struct Watcher {
    std::shared_ptr<ClientOutbox> outbox;
    std::uint64_t membership = 0;
    Subscription wanted;
  };
  std::map<ConnectionId, Watcher> watchers_;
  Presence presence_;
  std::shared_ptr<const std::vector<PersonSummary>> people_;  // list at the time of people_changes_
  std::uint64_t people_changes_ = 0;
  SharedText description_end_;  // null: not written since the start of the epoch
  bool description_due_ = false;
  bool status_due_ = false;
  bool divergence_due_ = false;
  bool frame_due_ = false;       // publish at once
  bool tick_frame_due_ = false;  // publish with the next tick
};

}  // namespace vat
