#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

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
  /// Part of a file, for another node.
  struct Part {
    std::string name;       ///< of the file
    std::size_t size = 0;   ///< of the file [bytes]
    std::string content{};  ///< of the part
  };
  /// Memory for a file of another node. It counts like a waiting file.
  using Room = std::shared_ptr<void>;

  /// `max_bytes` is the limit for all waiting files. `node` is the name of this node of a cluster,
  /// which the paths contain; empty: no cluster.
  explicit Downloads(std::size_t max_bytes = ServerLimits{}.max_download_bytes,
                     std::string node = {})
      : max_bytes_(max_bytes), node_(std::move(node)) {}

  /// Returns the name of the node in a path; empty: the path names no other node.
  std::string other_node(std::string_view path) const;

  /// Adds a file. Returns its path, or nothing if the limit would be exceeded.
  std::optional<std::string> add(File file, SteadyClock::time_point now);
  std::optional<File> take(std::string_view path, SteadyClock::time_point now);
  /// Returns the part of a file from `offset`, with at most `max_bytes`. Removes the file with its
  /// last part.
  std::optional<Part> read(std::string_view path, std::size_t offset, std::size_t max_bytes,
                           SteadyClock::time_point now);
  /// Returns room, or null if the limit would be exceeded. The room must not outlive this object.
  Room reserve(std::size_t bytes, SteadyClock::time_point now);
  /// Removes expired files. Returns the size of the remaining files [bytes].
  std::size_t forget_old(SteadyClock::time_point now);

 private:
  struct Waiting {
    File file;
    SteadyClock::time_point end;
  };
  void forget_old_locked(SteadyClock::time_point now);

  const std::size_t max_bytes_;
  const std::string node_;
  OwnedMutex mutex_;
  std::map<std::string, Waiting, std::less<>> files_;
  std::size_t bytes_ = 0;
};

/// Fetches a file of another node, and then calls a function with the response.
using FetchDownload = std::function<void(const std::string& node, const std::string& path,
                                         std::function<void(HttpResponse)> answer)>;

/// Returns a handler for GET requests of the files. The handler passes other requests to `site`.
/// Without a cluster, `fetch` is empty.
HttpHandler with_downloads(HttpHandler site, Downloads& downloads, const Clock& clock,
                           FetchDownload fetch = {});
/// Returns the response with a file.
HttpResponse download_response(Downloads::File file);

}  // namespace vat
