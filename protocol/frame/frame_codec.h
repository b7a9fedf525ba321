#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "protocol/frame/grid_frame.h"

/// Encoder and decoder of the binary frames that FRAMES.md specifies. A key frame is complete. A
/// delta frame contains the changes since one or two earlier frames, its references.
namespace vat {

/// Greatest number of received frames that a client stores. Any two stored frames can be
/// references.
inline constexpr std::size_t kFrameRing = 16;
/// Greatest difference between the number of a frame and the number of its reference.
inline constexpr std::uint32_t kMaxReferenceDistance = 65'535;

/// References of a delta frame: frames that the client has received. `first` is the newer frame. If
/// both pointers are null, the frame is a key frame.
struct FrameReferences {
  const GridFrame* first = nullptr;
  const GridFrame* second = nullptr;
};

/// Returns whether `reference` can be a reference of `frame`. Both frames must have the same epoch,
/// scale and bodies. The number of `reference` must be smaller by 1 to kMaxReferenceDistance.
/// Detail and region can differ.
bool can_refer(const GridFrame& frame, const GridFrame& reference);

/// Encoder of frames. The only state of an encoder is reused memory, so that one encoder can encode
/// frames of several sessions. Not thread-safe.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// Returns the bytes of a frame, valid until the next call. The bytes depend only on the
  /// arguments, so that clients with the same references can share the bytes. The references must
  /// satisfy can_refer(), and the second must be older than the first. `stride` is a field of the
  /// header.
  std::span<const std::uint8_t> encode(const GridFrame& frame, const FrameReferences& references,
                                       std::uint8_t stride = 1);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Decoder of the frames of a session. Stores the last kFrameRing frames, starting with the last
/// key frame. Frames must be decoded in order.
class FrameDecoder {
 public:
  FrameDecoder();
  ~FrameDecoder();
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;

  /// Returns the decoded frame, valid until the next call. The decoded integers equal the encoded
  /// integers, for any references. A key frame discards all earlier frames. Returns an error if a
  /// byte does not conform to FRAMES.md. The decoder is then unchanged. Error codes: bad_magic,
  /// bad_version, bad_type, bad_header, bad_block, bad_check, missing_reference, truncated,
  /// extra_bytes.
  Result<const GridFrame*> decode(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Return header fields of a valid frame.
std::uint32_t frame_number(std::span<const std::uint8_t> frame);
bool is_key_frame(std::span<const std::uint8_t> frame);

/// Encode or decode a single key frame.
std::vector<std::uint8_t> encode_key_frame(const GridFrame& frame);
Result<GridFrame> decode_key_frame(std::span<const std::uint8_t> bytes);

}  // namespace vat
