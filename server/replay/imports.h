#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "server/history/recording.h"
#include "server/messages/rpc_message.h"
#include "server/support/clock.h"
#include "server/support/owned_mutex.h"
#include "server/transport/transport.h"

namespace vat {

/// Recordings that clients upload in parts. Incomplete and unused recordings expire. Thread-safe.
class Imports {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{512} << 20;  ///< size of all files
  static constexpr std::size_t kMaxFiles = 16;
  static constexpr std::chrono::seconds kPatience{600};

  explicit Imports(std::size_t most_bytes = kMaxBytes) : most_bytes_(most_bytes) {}

  /// Part of a file, starting at `offset`. Without a name, the part starts a new file.
  struct Chunk {
    std::optional<std::string> name;
    std::size_t size = 0;  ///< size of the whole file
    std::size_t offset = 0;
    std::vector<std::uint8_t> bytes;
  };
  struct Progress {
    std::string name;  ///< unguessable name
    std::size_t received = 0;
    bool is_whole = false;
  };
  std::variant<Progress, RpcError> add(ConnectionId client, Chunk part,
                                       SteadyClock::time_point now);
  /// Returns the bytes of a complete file. The file remains in memory.
  std::optional<std::vector<std::uint8_t>> take_bytes(const std::string& name);
  /// Stores the recording that was read from the bytes of a file.
  void put(const std::string& name, std::shared_ptr<const Recording> recording,
           SteadyClock::time_point now);
  void forget(const std::string& name);
  std::shared_ptr<const Recording> find(const std::string& name, SteadyClock::time_point now);
  /// Removes expired files. Returns the size of the remaining files [bytes].
  std::size_t forget_old(SteadyClock::time_point now);

 private:
  struct File {
    ConnectionId client = 0;
    std::size_t size = 0;
    std::vector<std::uint8_t> bytes;
    std::shared_ptr<const Recording> recording;
    std::size_t held = 0;  ///< bytes that count towards the limit
    SteadyClock::time_point end;
  };
  void forget_old_locked(SteadyClock::time_point now);
  std::size_t held() const;

  const std::size_t most_bytes_;
  OwnedMutex mutex_;
  std::map<std::string, File> files_;
};

}  // namespace vat
