#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/storage/checkpoint_store.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Store of the newest state of each session, one file per session. The files are not synchronised:
/// they survive the end of the process, and may be lost or damaged by a power failure. The next
/// state of a session replaces its file, usually before the system has written the file to the
/// disk, so that most states cost no written bytes. Thread-safe. Functions throw StorageError.
class RecentStates {
 public:
  /// Creates a missing folder. `bytes_in_all` limits the size of all files.
  RecentStates(std::string folder, std::size_t bytes_in_all);

  /// Replaces the state of the checkpoint's session. If the states would exceed their size, removes
  /// the previous state of the session and writes nothing. Returns whether the state was written.
  bool write(const Checkpoint& checkpoint);
  /// Returns the newest state of the session that is complete, if any.
  std::optional<Checkpoint> read(std::uint64_t session);
  /// Removes the states of all other sessions.
  void keep_only(const std::vector<std::uint64_t>& sessions);
  void remove(std::uint64_t session);

 private:
  /// A session has two file names. A replaced file is removed after the new one is complete, and is
  /// not overwritten: some file systems write a file to the disk at once if it is overwritten.
  struct Files {
    std::array<std::size_t, 2> bytes{};
    std::size_t newest = 0;
  };
  std::string path(std::uint64_t session, std::size_t which) const;
  void remove_file(std::uint64_t session, Files& files, std::size_t which);

  const std::string folder_;
  const std::size_t bytes_in_all_;
  OwnedMutex mutex_;
  std::map<std::uint64_t, Files> files_;
  std::size_t bytes_ = 0;  ///< of all files
};

}  // namespace vat
