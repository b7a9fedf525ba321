#pragma once

#include <chrono>
#include <cstddef>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>

#include "server/clock.h"
#include "server/limits.h"
#include "server/net/transport.h"

namespace vat {

/// Files that were made for one client each, for a while: whoever knows a file's path gets it,
/// once. Safe to use from any thread.
class Downloads {
 public:
  static constexpr std::string_view kFolder = "/downloads/";
  static constexpr std::chrono::seconds kPatience{60};

  struct File {
    std::string name;  ///< that a browser gives it
    std::string content;
  };

  /// `max_bytes`: of all that wait.
  explicit Downloads(std::size_t max_bytes = ServerLimits{}.max_download_bytes)
      : max_bytes_(max_bytes) {}

  /// A path that nobody can guess; nothing where too much waits already.
  std::optional<std::string> add(File file, SteadyClock::time_point now);
  std::optional<File> take(std::string_view path, SteadyClock::time_point now);
  /// Those that have waited long enough go; what the others take.
  std::size_t forget_old(SteadyClock::time_point now);

 private:
  struct Waiting {
    File file;
    SteadyClock::time_point end;
  };
  void forget_old_locked(SteadyClock::time_point now);

  const std::size_t max_bytes_;
  std::mutex mutex_;
  std::map<std::string, Waiting, std::less<>> files_;
  std::size_t bytes_ = 0;
};

/// Answers GET for those files, and all else as `site` does.
HttpHandler with_downloads(HttpHandler site, Downloads& downloads, const Clock& clock);

}  // namespace vat
