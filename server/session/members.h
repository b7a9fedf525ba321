#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/types.h"
#include "server/session/client_outbox.h"
#include "server/session/subscription.h"

namespace vat {

/// A client in a session.
struct Member {
  std::shared_ptr<ClientOutbox> outbox;
  std::uint64_t membership = 0;
  std::optional<Subscription> subscription;
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
  /// Members get no frame of an earlier epoch from now on.
  void start_epoch(std::uint32_t epoch);
  /// Whether a member has subscribed to the frame of this tick.
  bool is_watched(std::uint64_t tick) const;
  bool is_watched() const;
  /// What the subscribers want to see of particles beside their places.
  ByAttribute<bool> wanted_attributes() const;
  void close_silent(SteadyClock::time_point now, std::chrono::seconds patience);
  void forget_grabs();
  void forget_grab(std::uint64_t grab);
  void forget_grabs_of(BodyId body);

  std::map<ConnectionId, Member>& all() { return members_; }

 private:
  std::map<ConnectionId, Member> members_;
};

}  // namespace vat
