#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "server/messages/limits.h"
#include "server/support/clock.h"
#include "server/support/owned_mutex.h"
#include "server/transport/transport.h"

namespace vat {

/// Files for download by one client each. A client gets a file once, by an unguessable path, before
/// the file expires. Thread-safe.
class Downloads {
 public:
  static constexpr std::string_view kFolder = "/downloads/";
  static constexpr std::chrono::seconds kPatience{60};

  struct File {
    std::string name;  ///< name suggested to the browser
    std::string content;
  };

  /// `max_bytes` is the limit for all waiting files.
  explicit Downloads(std::size_t max_bytes = ServerLimits{}.max_download_bytes)
      : max_bytes_(max_bytes) {}

  /// Adds a file. Returns its path, or nothing if the limit would be exceeded.
  std::optional<std::string> add(File file, SteadyClock::time_point now);
  std::optional<File> take(std::string_view path, SteadyClock::time_point now);
  /// Removes expired files. Returns the size of the remaining files [bytes].
  std::size_t forget_old(SteadyClock::time_point now);

 private:
  struct Waiting {
    File file;
    SteadyClock::time_point end;
  };
  void forget_old_locked(SteadyClock::time_point now);

  const std::size_t max_bytes_;
  OwnedMutex mutex_;
  std::map<std::string, Waiting, std::less<>> files_;
  std::size_t bytes_ = 0;
};

/// Returns a handler for GET requests of the files. The handler passes other requests to `site`.
HttpHandler with_downloads(HttpHandler site, Downloads& downloads, const Clock& clock);

}  // namespace vat
