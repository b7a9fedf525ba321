#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include "core/types.h"
#include "server/access/role.h"
#include "server/access/token.h"
#include "server/clients/client_outbox.h"
#include "server/frames/subscription.h"

namespace vat {

/// Number of a participant in its session, from 1. A number is not used twice.
using ParticipantNumber = std::uint64_t;
/// Sender of the server's own commands. It is not a participant.
inline constexpr ParticipantNumber kServerItself = 0;

/// Position at which a participant points. With `direction`, a ray from this position.
struct Pointer {
  Vec3 position;
  std::optional<Vec3> direction;
  bool operator==(const Pointer&) const = default;
};

/// Participant of a session. A participant is away if its connection has ended. Another connection
/// can resume the participant. A placeholder was never connected and represents the sender of
/// commands in a replayed log.
struct Participant {
  ParticipantNumber number = 0;
  std::string name;
  Role role = Role::viewer;
  std::shared_ptr<ClientOutbox> outbox;  ///< null: away, or a placeholder
  std::uint64_t membership = 0;
  std::optional<Subscription> subscription;  ///< retained while the participant is away
  std::map<std::uint64_t, BodyId> grabs;     ///< body of each grab; key: grab id
  /// Hash of the token with which another connection resumes the participant.
  std::optional<TokenHash> resume;
  std::optional<SteadyClock::time_point> away_since;
  std::optional<Pointer> pointer;
  /// Time of the last use of each grab. The key is the grab id.
  std::map<std::uint64_t, SteadyClock::time_point> grab_uses;

  bool is_here() const { return outbox != nullptr; }
  bool is_away() const { return away_since.has_value(); }
  bool is_placeholder() const { return !is_here() && !is_away(); }
};

/// Participants of a session. Not thread-safe. A reference is valid until the participant is
/// removed.
class Participants {
 public:
  /// Returns the number of participants with a connection.
  std::size_t connected() const { return by_client_.size(); }
  std::size_t away() const;

  /// Return the participant, or null if there is no such participant.
  Participant* find(ParticipantNumber number);
  Participant* find_client(ConnectionId client);
  Participant* find_resume(const TokenHash& token);
  /// Returns the participant with this grab, or null.
  Participant* holder_of(std::uint64_t grab);
  /// Returns a participant that has grabbed the body, or null.
  const Participant* holder_of_body(BodyId body) const;

  /// Adds a participant with the next number.
  Participant& add(std::string name, Role role);
  void set_role(Participant& participant, Role role);
  /// Adds a placeholder if no participant has this number.
  Participant& find_or_add(ParticipantNumber number);
  void remove(ParticipantNumber number);
  ParticipantNumber last_number() const { return last_number_; }
  /// Ensures that participants added later have numbers greater than `number`.
  void skip_to(ParticipantNumber number) { last_number_ = std::max(last_number_, number); }
  /// Returns the number of changes of participants, roles and connections.
  std::uint64_t changes() const { return changes_; }
  /// Counts a change that was made outside this class.
  void touch() { ++changes_; }
  /// Sets the connection, which must not belong to another participant.
  void connect(Participant& participant, std::shared_ptr<ClientOutbox> outbox,
               std::uint64_t membership);
  void disconnect(Participant& participant);
  /// Marks all participants without a connection as away.
  void send_away(SteadyClock::time_point now);

  /// Sends an event to all participants with at least this role.
  void send_event(std::string text, Role least = Role::viewer);
  /// Drops frames of earlier epochs for all clients.
  void start_epoch(std::uint32_t epoch);
  /// Returns whether a connected participant has subscribed to the frame of this tick.
  bool is_watched(std::uint64_t tick) const;
  bool is_watched() const;
  /// Returns the particle attributes that subscribers have requested.
  ByAttribute<bool> wanted_attributes() const;
  void close_silent(SteadyClock::time_point now, std::chrono::seconds patience);
  void forget_grabs();
  void forget_grab(std::uint64_t grab);
  void forget_grabs_of(BodyId body);

  /// Returns all participants in ascending order of their numbers.
  const std::map<ParticipantNumber, Participant>& all() const { return all_; }

 private:
  std::map<ParticipantNumber, Participant> all_;
  std::map<ConnectionId, ParticipantNumber> by_client_;
  ParticipantNumber last_number_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace vat
