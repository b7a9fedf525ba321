#pragma once

#include <chrono>
#include <utility>

#include "server/relay/relay_entry.h"

namespace vat {

/// Interval of a relay's questions on the link of a client. The owner answers each.
inline constexpr std::chrono::seconds kQuestionInterval(4);
/// Silence of an owner after which a link has failed.
inline constexpr std::chrono::seconds kOwnerSilence(10);

/// End of a link at a relay. Thread-safe.
class RelayEnd {
 public:
  explicit RelayEnd(RelayPlace place) : place_(std::move(place)) {}
  virtual ~RelayEnd() = default;
  RelayEnd(const RelayEnd&) = delete;
  RelayEnd& operator=(const RelayEnd&) = delete;

  const RelayPlace& place() const { return place_; }
  /// Takes a message of the owner.
  virtual void receive(RelayMessage message) = 0;
  /// Ends the link, because the owner cannot be reached.
  virtual void fail() = 0;
  /// Called if the session has another owner.
  virtual void owner_changed() { fail(); }
  /// Fails if the owner is silent. Call it about once per second.
  virtual void look() = 0;

 private:
  const RelayPlace place_;
};

}  // namespace vat
