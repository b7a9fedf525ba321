#pragma once

#include <memory>
#include <string>
#include <variant>

#include "server/session/core/session_history.h"
#include "server/session/core/session_notifier.h"

namespace vat {

/// Request of a connection to take part in a session.
struct JoinRequest {
  std::string name;                   ///< empty: the server chooses one
  std::optional<std::string> resume;  ///< token of the participant to resume
  std::optional<Role> role;           ///< by invitation; absent: the session's default
  bool passes_lock = false;
};

/// Result of a join.
struct JoinedParticipant {
  const Participant& participant;
  std::string resume;  ///< token with which another connection can resume the participant
  bool resumed = false;
};

/// Manages joining, leaving and the roles of a session's participants. Departures and released
/// grabs are logged. Used by one thread at a time.
class SessionPeople {
 public:
  SessionPeople(SessionContext& context, SessionRun& run, Participants& participants,
                SessionHistory& history, SessionNotifier& notifier);

  /// Adds a participant, or resumes one and closes its other connection. Ends the connection's
  /// earlier participation in the session.
  std::variant<JoinedParticipant, RpcError> join(const std::shared_ptr<ClientOutbox>& outbox,
                                                 std::uint64_t membership,
                                                 const JoinRequest& request,
                                                 SteadyClock::time_point now);
  /// The connection's participant, if any, is away: it can be resumed for a limited time.
  void disconnect(ConnectionId client, SteadyClock::time_point now);
  /// Ends the participant's grabs and removes it. If that cannot be logged, the participant is away
  /// and leaves later.
  void leave(ParticipantNumber number);
  /// Executes an entry kLeaveEntry.
  void execute_leave(const LogEntry& entry);
  /// Executes an entry kReleaseGrabsEntry.
  void execute_release(const LogEntry& entry);
  /// Removes the participant and closes its connection with the reason.
  void kick(ParticipantNumber number, const std::string& reason);
  void rename(Participant& participant, std::string name);
  /// A participant that becomes a viewer loses its grabs. A new owner replaces the current one, who
  /// becomes a controller.
  void set_role(Participant& participant, Role role);
  /// Stores the settings, applies them and sends session.configured.
  void configure(SessionSettings settings);
  const SessionSettings& settings() const { return context_.settings; }
  Json describe_settings() const;
  /// Removes participants that have been away for the resume time.
  void end_absences(SteadyClock::time_point now);
  /// Marks all participants as away after a recovery. Removes participants that cannot resume.
  void recover(SteadyClock::time_point now);

 private:
  Participant& add(const ClientOutbox& outbox, const JoinRequest& request, std::string& token);
  void release_connection(const Participant& participant, ConnectionId next);
  /// Limits the number of participants that are away.
  void bound_absences();
  void release_grabs(const Participant& participant);

  SessionContext& context_;
  SessionRun& run_;
  Participants& participants_;
  SessionHistory& history_;
  SessionNotifier& notifier_;
};

}  // namespace vat
