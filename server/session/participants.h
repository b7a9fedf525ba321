#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "server/access/role.h"
#include "server/access/token.h"
#include "server/session/client_outbox.h"
#include "server/session/subscription.h"

namespace vat {

/// Names a participant of a session; never used twice in it. The first is 1.
using ParticipantNumber = std::uint64_t;

/// Where somebody points: at a place, or from one in a direction.
struct Pointer {
  Vec3 position;
  std::optional<Vec3> direction;
  bool operator==(const Pointer&) const = default;
};

/// Who takes part in a session. Outlives its connection for a while, in which another one may
/// resume it. A participant that has no connection and was never one's is a ghost: it stands for
/// whoever gave the commands of a log that is carried out again.
struct Participant {
  ParticipantNumber number = 0;
  std::string name;
  Role role = Role::viewer;
  std::shared_ptr<ClientOutbox> outbox;  ///< null: away, or a ghost
  std::uint64_t membership = 0;
  std::optional<Subscription> subscription;  ///< kept while it is away
  std::map<std::uint64_t, BodyId> grabs;     ///< by the ids that the session gave
  std::optional<TokenHash> resume;  ///< of the token by which another connection takes over
  std::optional<SteadyClock::time_point> away_since;
  std::optional<Pointer> pointer;
  std::map<std::uint64_t, SteadyClock::time_point> grab_uses;  ///< the last of each

  bool is_here() const { return outbox != nullptr; }
  bool is_away() const { return away_since.has_value(); }
  bool is_ghost() const { return !is_here() && !is_away(); }
};

/// The participants of a session; used by one thread at a time. References to one are valid until
/// it is removed.
class Participants {
 public:
  /// Of those that have a connection.
  std::size_t connected() const { return by_client_.size(); }
  std::size_t away() const;

  /// Null if there is none.
  Participant* find(ParticipantNumber number);
  Participant* find_client(ConnectionId client);
  Participant* find_resume(const TokenHash& token);
  /// The one that has this grab, or null.
  Participant* holder_of(std::uint64_t grab);
  /// The one that holds the body by some grab, or null.
  const Participant* holder_of_body(BodyId body) const;

  /// A further one, with the next number.
  Participant& add(std::string name, Role role);
  void set_role(Participant& participant, Role role);
  /// The one of this number; a ghost where there is none yet.
  Participant& ghost(ParticipantNumber number);
  void remove(ParticipantNumber number);
  ParticipantNumber last_number() const { return last_number_; }
  /// Those that come have greater numbers than this.
  void skip_to(ParticipantNumber number) { last_number_ = std::max(last_number_, number); }
  /// Counts changes of who takes part, as what, and by which connection.
  std::uint64_t changes() const { return changes_; }
  /// Something of a participant has changed that is no business of this class.
  void touch() { ++changes_; }
  /// Gives the participant a connection, which must have no other.
  void connect(Participant& participant, std::shared_ptr<ClientOutbox> outbox,
               std::uint64_t membership);
  void disconnect(Participant& participant);
  /// All who have no connection are away from now on.
  void send_away(SteadyClock::time_point now);

  /// To those of this role and those above.
  void send_event(const std::string& text, Role least = Role::viewer);
  /// No client gets a frame of an earlier epoch from now on.
  void start_epoch(std::uint32_t epoch);
  /// Whether somebody here has subscribed to the frame of this tick.
  bool is_watched(std::uint64_t tick) const;
  bool is_watched() const;
  /// What the subscribers want to see of particles beside their places.
  ByAttribute<bool> wanted_attributes() const;
  void close_silent(SteadyClock::time_point now, std::chrono::seconds patience);
  void forget_grabs();
  void forget_grab(std::uint64_t grab);
  void forget_grabs_of(BodyId body);

  /// In the order of their numbers.
  const std::map<ParticipantNumber, Participant>& all() const { return all_; }

 private:
  std::map<ParticipantNumber, Participant> all_;
  std::map<ConnectionId, ParticipantNumber> by_client_;
  ParticipantNumber last_number_ = 0;
  std::uint64_t changes_ = 0;
};

}  // namespace vat
