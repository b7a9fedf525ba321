#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "protocol/frame/grid_frame.h"

/// The binary frames of FRAMES.md.
namespace vat {

/// Number of received frames that a client stores, beginning with the last key frame. Any two of
/// them can be references.
inline constexpr std::size_t kFrameRing = 16;
/// Largest difference between the numbers of a frame and its reference.
inline constexpr std::uint32_t kMaxReferenceDistance = 65'535;

/// The references of a delta frame: frames that the client has, the newer one first. If both are
/// null, the frame is a key frame.
struct FrameReferences {
  const GridFrame* first = nullptr;
  const GridFrame* second = nullptr;
};

/// Returns whether `reference` can be a reference of `frame`: it has the same epoch, scale and
/// blocks, and its number is 1 to kMaxReferenceDistance smaller. Detail and region can differ.
bool can_refer(const GridFrame& frame, const GridFrame& reference);

/// Encodes frames. It has no state except reused memory, so it can encode frames of any sessions.
/// Not thread-safe.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// Returns the bytes of a frame, valid until the next call. They depend on the arguments only, so
  /// clients with the same references share them. The header contains `stride`. The references must
  /// satisfy can_refer(), and the second must be older than the first.
  std::span<const std::uint8_t> encode(const GridFrame& frame, const FrameReferences& references,
                                       std::uint8_t stride = 1);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decodes the frames of a session in order and stores the last kFrameRing of them.
class FrameDecoder {
 public:
  FrameDecoder();
  ~FrameDecoder();
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;

  /// Returns the decoded frame, valid until the next call, if every byte conforms to FRAMES.md. Its
  /// integers equal those that were encoded, for any references. A key frame discards all earlier
  /// frames. An invalid frame changes nothing. Error codes: bad_magic, bad_version, bad_type,
  /// bad_header, bad_block, bad_check, missing_reference, truncated, extra_bytes.
  Result<const GridFrame*> decode(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Fields of the header of a valid frame.
std::uint32_t frame_number(std::span<const std::uint8_t> frame);
bool is_key_frame(std::span<const std::uint8_t> frame);

/// Encodes or decodes a single key frame.
std::vector<std::uint8_t> encode_key_frame(const GridFrame& frame);
Result<GridFrame> decode_key_frame(std::span<const std::uint8_t> bytes);

}  // namespace vat
