#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "server/nats/stream.h"
#include "server/support/clock.h"

namespace vat {

/// Contents of the saved states and scenes of a cluster: a stream with their chunks. Each content
/// has a place OWNER.MINUTE.TOKEN, whose owner is a session or "scenes". Thread-safe. Functions
/// wait, and throw NatsError.
class SavedContents {
 public:
  static constexpr std::size_t kChunkBytes = 384 * 1024;  ///< a message of NATS has at most 1 MB

  /// The arguments must outlive the contents.
  SavedContents(NatsConnection& connection, const Clock& clock);

  /// Stores a content, and returns its place.
  std::string write(const std::string& owner, std::string_view content);
  /// Returns the content with this size [bytes]. Throws StorageError (kind `corrupt`) if it is
  /// incomplete.
  std::string read(const std::string& place, std::size_t size);
  void remove(const std::string& place);
  void remove_all(const std::string& owner);
  /// Removes the owner's contents that are not in `used` and at least kUnusedMinutes old: a node
  /// may have ended during their writes.
  void remove_unused(const std::string& owner, const std::set<std::string>& used);
  /// After the longest write, which ends with the lease of its node.
  static constexpr std::uint64_t kUnusedMinutes = 10;

 private:
  std::uint64_t minute() const;

  const Clock& clock_;
  Stream stream_;
};

}  // namespace vat
