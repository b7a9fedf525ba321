#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "server/clock.h"
#include "server/net/transport.h"
#include "server/replay/recording.h"
#include "server/session/rpc_message.h"

namespace vat {

/// Recordings that clients bring, part by part, and hold until somebody opens them. What is not
/// gone on with, or not opened, is forgotten after a while. Safe to use from any thread.
class Imports {
 public:
  static constexpr std::size_t kMaxBytes = std::size_t{512} << 20;  ///< of all that is held
  static constexpr std::size_t kMaxFiles = 16;
  static constexpr std::chrono::seconds kPatience{600};

  explicit Imports(std::size_t most_bytes = kMaxBytes) : most_bytes_(most_bytes) {}

  /// A part of a file, which begins at `offset`; without a name it is the first.
  struct Part {
    std::optional<std::string> name;
    std::size_t size = 0;  ///< of the whole file
    std::size_t offset = 0;
    std::vector<std::uint8_t> bytes;
  };
  struct Progress {
    std::string name;  ///< that nobody can guess
    std::size_t received = 0;
    bool is_whole = false;
  };
  std::variant<Progress, RpcError> add(ConnectionId client, Part part, SteadyClock::time_point now);
  /// The bytes of a file that is whole; it is still held.
  std::optional<std::vector<std::uint8_t>> take_bytes(const std::string& name);
  /// What they were.
  void put(const std::string& name, std::shared_ptr<const Recording> recording,
           SteadyClock::time_point now);
  void forget(const std::string& name);
  std::shared_ptr<const Recording> find(const std::string& name, SteadyClock::time_point now);
  /// Those that have waited long enough go; what the others take.
  std::size_t forget_old(SteadyClock::time_point now);

 private:
  struct File {
    ConnectionId client = 0;
    std::size_t size = 0;
    std::vector<std::uint8_t> bytes;
    std::shared_ptr<const Recording> recording;
    std::size_t held = 0;  ///< bytes that count
    SteadyClock::time_point end;
  };
  void forget_old_locked(SteadyClock::time_point now);
  std::size_t held() const;

  const std::size_t most_bytes_;
  std::mutex mutex_;
  std::map<std::string, File> files_;
};

}  // namespace vat
