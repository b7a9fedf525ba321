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

/// The files of a folder, read once: a request can name only what was there at the start, so no
/// path leads out of the folder, and a rebuild does not mix old files with new ones.
class StaticFiles {
 public:
  struct File {
    std::string content_type;
    std::string content;
  };

  /// Reads the regular files of the folder and its sub-folders; symbolic links and names that begin
  /// with '.' are left out. A folder that does not exist is empty. Fails where something cannot be
  /// read or a limit is passed.
  static Result<StaticFiles> read(const std::filesystem::path& folder,
                                  const StaticFilesLimits& limits = {});

  /// The file at a path such as "/assets/main.js"; null where there is none.
  const File* find(std::string_view path) const;
  bool empty() const { return files_.empty(); }

 private:
  std::map<std::string, File, std::less<>> files_;
};

/// Content type by the ending of a file's name.
std::string content_type_of(const std::filesystem::path& name);

}  // namespace vat
