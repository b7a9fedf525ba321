#pragma once

#include <memory>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "server/session/core/session_history.h"
#include "server/session/core/session_notifier.h"

namespace vat {

/// Request of a connection to join a session.
struct JoinRequest {
  std::string name;                   ///< empty: the server chooses a name
  std::optional<std::string> resume;  ///< token of the participant to resume
  std::optional<Role> role;           ///< role of an invitation; absent: default role
  std::optional<Role> greatest_role;  ///< greatest role that the client requests; absent: any
  bool passes_lock = false;
};

/// Result of a successful join.
struct JoinedParticipant {
  const Participant& participant;
  std::string resume;  ///< token with which another connection can resume the participant
  bool resumed = false;
};

/// Management of a session's participants: joining, leaving and roles. Departures and ends of grabs
/// take effect after their log entries are stored, see due_entries(). Not thread-safe.
class SessionPeople {
 public:
  SessionPeople(SessionContext& context, SessionRun& run, Participants& participants,
                SessionHistory& history, SessionNotifier& notifier);

  /// Adds a participant, or resumes a participant and closes its other connection. Removes another
  /// participant of the same connection.
  std::variant<JoinedParticipant, RpcError> join(const std::shared_ptr<ClientOutbox>& outbox,
                                                 std::uint64_t membership,
                                                 const JoinRequest& request,
                                                 SteadyClock::time_point now);
  /// Marks the connection's participant, if any, as away. The participant can be resumed for a
  /// limited time.
  void disconnect(ConnectionId client, SteadyClock::time_point now);
  /// Ends the participant's connection to the session. The participant cannot be resumed. The next
  /// due_entries() contain its departure.
  void leave(ParticipantNumber number);
  /// Returns the log entries of departures and of ends of grabs that are due: participants that
  /// have left or were away longer than the resume time, and viewers with grabs.
  std::vector<LogEntry> due_entries(SteadyClock::time_point now) const;
  /// Executes the stored entries of due_entries().
  void execute(std::span<const LogEntry> entries);
  /// Executes a log entry with the method kLeaveEntry.
  void execute_leave(const LogEntry& entry);
  /// Executes a log entry with the method kReleaseGrabsEntry.
  void execute_release(const LogEntry& entry);
  /// Removes the participant and closes its connection with `reason`.
  void kick(ParticipantNumber number, const std::string& reason);
  void rename(Participant& participant, std::string name);
  /// Sets the role of a participant. A participant that becomes a viewer loses its grabs by the
  /// next due_entries(). A new owner replaces the current owner, who becomes a controller.
  void set_role(Participant& participant, Role role);
  /// Applies the settings, and sends session.configured.
  void configure(SessionSettings settings);
  const SessionSettings& settings() const { return context_.settings; }
  Json describe_settings() const;
  /// Marks all participants as away after a recovery. Removes participants without a resume token.
  void recover(SteadyClock::time_point now);

 private:
  Participant& add(const ClientOutbox& outbox, const JoinRequest& request, std::string& token);
  void release_connection(const Participant& participant, ConnectionId next);
  /// Limits the number of absent participants by removing the longest absent participant.
  void bound_absences();

  SessionContext& context_;
  SessionRun& run_;
  Participants& participants_;
  SessionHistory& history_;
  SessionNotifier& notifier_;
};

}  // namespace vat
