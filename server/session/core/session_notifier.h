#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "server/frames/frame_feed.h"
#include "server/people/presence.h"
#include "server/session/core/session_history.h"
#include "server/session/core/session_summary.h"

namespace vat {

/// Events, descriptions and frames of a session for its clients. Commands mark what has changed;
/// announce() sends it once, so that many commands cause one description, one status and one
/// frame. Used by one thread at a time.
class SessionNotifier {
 public:
  /// `participants` receive the events. `recorded` are those of a replay's recording.
  SessionNotifier(const SessionContext& context, const SessionRun& run, const SessionClock& clock,
                  const SessionHistory& history, Participants& participants,
                  Participants& recorded);

  void mark_description() { description_due_ = true; }
  void mark_status() { status_due_ = true; }
  /// The current state is published even without a tick.
  void mark_frame() { frame_due_ = true; }
  void mark_divergence() { divergence_due_ = true; }
  /// Frames of earlier epochs are dropped. Marks description, status and frame.
  void start_epoch();
  /// Another simulation begins: frames cover its vat.
  void reset_frames();
  /// Bodies have moved other than by ticks, so their accelerations are unknown.
  void forget_velocities() { publisher_.forget(); }

  /// Sends frames to the participant: the current state of a paused session, or else the next
  /// tick's. Clients that subscribe between two ticks therefore share a key frame.
  void subscribe(Participant& participant, const Subscription& subscription,
                 SteadyClock::time_point now);
  void unsubscribe(Participant& participant);
  void remove_viewer(ConnectionId client) { frames_->remove(client); }

  /// Before a tick: keeps the velocities if a client asked for accelerations.
  void prepare_tick();
  void tell_guard(const AdvanceReport& report);
  /// After a tick: sends the description if due, and publishes the state if a client is due it.
  void publish_tick();
  /// Sends all that is due.
  void announce();
  void announce_status();
  Presence& presence() { return presence_; }
  /// Sends presence.changed if participants have changed.
  void tell_presence(SteadyClock::time_point now);

  /// Returns the session's description, as session.join and session.description contain it.
  Json description() const;
  SessionSummary summary();
  /// Runs `task` on a frame thread, after the frames of all states published before.
  void post_behind_frames(std::function<void()> task) { frames_->post(std::move(task)); }

 private:
  Json status() const;
  void tell_description();
  void tell_divergence();
  void publish_frame();
  void fill_state();
  void list_people();

  const SessionContext& context_;
  const SessionRun& run_;
  const SessionClock& clock_;
  const SessionHistory& history_;
  Participants& participants_;
  Participants& recorded_;
  const std::shared_ptr<FrameFeed> frames_;
  StatePublisher publisher_;
  PublishedState state_;  // the next, or the memory of an older one
  Presence presence_;
  std::shared_ptr<const std::vector<PersonSummary>> people_;  // as of `people_changes_`
  std::uint64_t people_changes_ = 0;
  bool description_due_ = false;
  bool status_due_ = false;
  bool divergence_due_ = false;
  bool frame_due_ = false;       // at once
  bool tick_frame_due_ = false;  // with the next tick
};

}  // namespace vat
