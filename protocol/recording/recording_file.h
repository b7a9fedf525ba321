#pragma once

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "core/support/result.h"
#include "protocol/recording/recording_index.h"

namespace vat {

/// A complete frame recording on the disk, open for reading. Paths of errors begin with the name of
/// the file.
class RecordingFile {
 public:
  /// Opens a file and reads its index. Fails with the codes of read_recording_index() and io_error.
  static Result<RecordingFile> open(const std::string& name);

  const RecordingIndex& index() const { return index_; }
  std::uint64_t size() const { return size_; }
  /// Returns bytes of the file. The range must be inside the file.
  Result<std::vector<std::uint8_t>> read(std::uint64_t offset, std::size_t length);
  /// Returns a frame. The content is not checked.
  Result<std::vector<std::uint8_t>> frame(std::size_t number);
  /// Returns the JSON text of a description. Fails with the code damaged.
  Result<std::string> description(std::size_t number);

 private:
  std::string name_;
  std::ifstream file_;
  std::uint64_t size_ = 0;
  RecordingIndex index_;
};

}  // namespace vat
