#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace vat {

struct StaticFilesLimits {
  std::size_t max_files = 1000;
  std::size_t max_bytes = 64 * 1024 * 1024;  ///< of all files together
};

/// Files of a folder, read once at the start. No path leads out of the folder, and a rebuild does
/// not mix old and new files.
class StaticFiles {
 public:
  struct File {
    std::string content_type;
    std::string content;
  };

  /// Reads the regular files of the folder and its sub-folders, except symbolic links and names
  /// that begin with '.'. A missing folder is empty. Fails if a file cannot be read or a limit is
  /// exceeded.
  static Result<StaticFiles> read(const std::filesystem::path& folder,
                                  const StaticFilesLimits& limits = {});

  /// Returns the file at a path such as "/assets/main.js", or null.
  const File* find(std::string_view path) const;
  bool empty() const { return files_.empty(); }

 private:
  std::map<std::string, File, std::less<>> files_;
};

/// Returns the content type for the ending of a file name.
std::string content_type_of(const std::filesystem::path& name);

}  // namespace vat
