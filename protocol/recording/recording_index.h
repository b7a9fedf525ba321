#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string_view>
#include <vector>

#include "core/support/result.h"

/// Files of recorded frames (`.vatrec`), which PROTOCOL.md specifies ("Frame recordings"). A file
/// contains descriptions and frames, and ends with an index of their sizes.
namespace vat {

inline constexpr std::string_view kFrameRecordingMagic = "vat.frm\n";

// Limits of a file. A reader checks them before it allocates memory.
inline constexpr std::size_t kMaxRecordedFrames = 1'000'000;
inline constexpr std::size_t kMaxRecordedDescriptions = 10'000;
inline constexpr std::size_t kMaxRecordedBytes = std::size_t{64}
                                                 << 20;  ///< of a frame or description

/// A description in a file. It belongs to all frames from `first_frame` up to the next description.
struct RecordedDescription {
  std::uint32_t first_frame = 0;
  std::uint64_t offset = 0;
  std::uint32_t size = 0;  ///< [bytes]
  std::uint32_t check = 0;

  bool operator==(const RecordedDescription&) const = default;
};

/// A frame in a file.
struct RecordedFrame {
  std::uint64_t offset = 0;
  std::uint32_t size = 0;  ///< [bytes]
  bool is_key = false;

  bool operator==(const RecordedFrame&) const = default;
};

/// Offsets and sizes of the parts of a file.
class RecordingIndex {
 public:
  /// Adds a description, which the caller appends to the file. Its next frame must be a key frame.
  Status add_description(std::span<const std::uint8_t> description);
  /// Adds a frame, which the caller appends to the file. The first part of a file is a description.
  Status add_frame(std::span<const std::uint8_t> frame);
  /// Removes all frames from number `count` on, and their descriptions.
  void truncate(std::size_t count);

  const std::vector<RecordedDescription>& descriptions() const { return descriptions_; }
  const std::vector<RecordedFrame>& frames() const { return frames_; }
  /// Returns the offset of the end of the last frame or description.
  std::uint64_t content_end() const { return end_; }
  /// Returns the last key frame at or before a frame.
  std::size_t key_before(std::size_t frame) const;

 private:
  friend Result<RecordingIndex> read_index_content(std::span<const std::uint8_t> content);
  void place_parts();

  std::vector<RecordedDescription> descriptions_;
  std::vector<RecordedFrame> frames_;
  std::uint64_t end_ = 12;  // after the header
};

/// Returns the first bytes of a file.
std::vector<std::uint8_t> write_recording_header();
/// Returns the last bytes of a file: the index and the end mark.
std::vector<std::uint8_t> write_recording_index(const RecordingIndex& index);

/// Returns `length` bytes of a file from `offset` on, or an error. The range is inside the file.
using ReadBytes =
    std::function<Result<std::vector<std::uint8_t>>(std::uint64_t offset, std::size_t length)>;

/// Returns the index of a file with `size` bytes. Error codes: other_format, other_version,
/// incomplete, damaged, bad_value, and those of `read`. Checks header and index. Each frame has its
/// own check; see matches() for the descriptions.
Result<RecordingIndex> read_recording_index(std::uint64_t size, const ReadBytes& read);

/// Returns whether the bytes are those of the description in the index.
bool matches(const RecordedDescription& description, std::span<const std::uint8_t> bytes);

/// Returns whether a file that begins with these bytes is a frame recording.
bool is_frame_recording(std::span<const std::uint8_t> begin);

}  // namespace vat
