#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "server/http/negotiation.h"

namespace vat {

struct StaticFilesLimits {
  std::size_t max_files = 1000;
  std::size_t max_bytes = 64 * 1024 * 1024;  ///< total size of all files
};

/// Files of a folder, which are read once at the start. No request path can access files outside
/// the folder. A rebuild of the viewer during operation cannot mix old and new files. The files
/// NAME.br and NAME.gz are encodings of the file NAME, and have no separate paths.
class StaticFiles {
 public:
  struct Content {
    std::string bytes;
    std::string tag;  ///< value of the header ETag: a quoted hash of the bytes
  };
  struct File {
    std::string content_type;
    std::map<Encoding, Content> contents;  ///< always has Encoding::identity
  };

  /// Reads the regular files of the folder and its subfolders, except symbolic links and names that
  /// begin with '.'. A missing folder is treated as empty. Returns an error if a file cannot be
  /// read or a limit is exceeded.
  static Result<StaticFiles> read(const std::filesystem::path& folder,
                                  const StaticFilesLimits& limits = {});

  /// Returns the file at a path such as "/assets/main.js", or null.
  const File* find(std::string_view path) const;
  bool empty() const { return files_.empty(); }

 private:
  void join_encodings();

  std::map<std::string, File, std::less<>> files_;
};

/// Returns the content type for the extension of a file name.
std::string content_type_of(const std::filesystem::path& name);

}  // namespace vat
