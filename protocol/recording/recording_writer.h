#pragma once

#include <cstddef>
#include <string>

#include "core/support/result.h"
#include "protocol/files/output_file.h"
#include "protocol/recording/frame_recorder.h"
#include "protocol/recording/recording_file.h"
#include "protocol/recording/recording_index.h"

namespace vat {

/// Writer of a frame recording. The file has the extension ".part" until finish(). The path of
/// every error is the name of the file.
class RecordingWriter {
 public:
  static Result<RecordingWriter> create(const std::string& name);

  /// Copies the first `frames` frames of a recording, with their descriptions. Must be the first
  /// call.
  Status copy(RecordingFile& from, std::size_t frames);
  Status write(const FrameRecorder::Parts& parts);
  /// Writes the index and gives the file its name. There must be at least one frame.
  Status finish();

  const RecordingIndex& index() const { return index_; }

 private:
  explicit RecordingWriter(std::string name, OutputFile file)
      : name_(std::move(name)), file_(std::move(file)) {}
  Status append(std::span<const std::uint8_t> bytes);

  std::string name_;
  OutputFile file_;
  RecordingIndex index_;
};

}  // namespace vat
