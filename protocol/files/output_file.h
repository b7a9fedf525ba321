#pragma once

#include <cstdio>
#include <memory>
#include <string>
#include <string_view>

#include "core/support/result.h"

namespace vat {

/// File that is written as NAME.part and renamed to NAME by commit(). An incomplete file therefore
/// cannot be mistaken for a result. Devices and pipes are written directly. The path of every error
/// is the file name.
class OutputFile {
 public:
  /// Creates or replaces NAME.part.
  static Result<OutputFile> create(const std::string& name);

  /// Appends bytes.
  Status append(std::string_view bytes);
  /// Replaces the bytes from the offset on. Bytes between the end of the file and the offset become
  /// zero.
  Status write_at(std::size_t offset, std::string_view bytes);
  /// Closes the file and renames it to NAME. No writes are allowed afterwards.
  Status commit();

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  OutputFile(std::string name, std::string written_name, std::FILE* file);
  Error system_error(const char* what) const;

  std::string name_;
  std::string written_name_;  ///< name of the written file before commit()
  std::unique_ptr<std::FILE, Close> file_;
};

/// Creates or replaces a file with this content.
Status write_output_file(const std::string& name, std::string_view content);

}  // namespace vat
