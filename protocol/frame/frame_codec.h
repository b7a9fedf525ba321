#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/support/result.h"
#include "protocol/frame/grid_frame.h"

/// The binary frames of FRAMES.md.
namespace vat {

/// A client keeps that many of the last frames that it got, from the last key frame on; any two of
/// them may be references.
inline constexpr std::size_t kFrameRing = 16;
/// How much later than its references a frame may be, in numbers.
inline constexpr std::uint32_t kMaxReferenceDistance = 65'535;

/// What a delta frame builds on: frames that the client has got, the newest first. Both null: a key
/// frame.
struct FrameReferences {
  const GridFrame* first = nullptr;
  const GridFrame* second = nullptr;
};

/// Whether `reference` may be one of `frame`: an earlier number of the same epoch, at most
/// kMaxReferenceDistance before it, with the same scale and blocks. Detail and region may differ.
bool can_refer(const GridFrame& frame, const GridFrame& reference);

/// Makes the bytes of frames. One may make any frames in turn; it only keeps memory. Used by one
/// thread at a time.
class FrameEncoder {
 public:
  FrameEncoder();
  ~FrameEncoder();
  FrameEncoder(FrameEncoder&&) noexcept;
  FrameEncoder& operator=(FrameEncoder&&) noexcept;

  /// The bytes depend on the arguments alone, so that all clients with the same references share
  /// them; `stride` goes into the header. The references must be as can_refer() says, the second
  /// earlier than the first. The result lives until the next call.
  std::span<const std::uint8_t> encode(const GridFrame& frame, const FrameReferences& references,
                                       std::uint8_t stride = 1);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// A client's side: decodes one frame after the other and keeps the last kFrameRing of them.
class FrameDecoder {
 public:
  FrameDecoder();
  ~FrameDecoder();
  FrameDecoder(FrameDecoder&&) noexcept;
  FrameDecoder& operator=(FrameDecoder&&) noexcept;

  /// A key frame makes the decoder forget all before it.
  ///
  /// The frame, only if every byte is as FRAMES.md says: the same integers that were encoded,
  /// whatever its references were. It lives until the next call. A frame that is refused changes
  /// nothing. Error codes: bad_magic, bad_version, bad_type, bad_header, bad_block, bad_check,
  /// missing_reference, truncated, extra_bytes.
  Result<const GridFrame*> decode(std::span<const std::uint8_t> bytes);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// What a frame's header says; the bytes must be a frame's.
std::uint32_t frame_number(std::span<const std::uint8_t> frame);
bool is_key_frame(std::span<const std::uint8_t> frame);

/// A key frame and its content, for who has no use for more.
std::vector<std::uint8_t> encode_key_frame(const GridFrame& frame);
Result<GridFrame> decode_key_frame(std::span<const std::uint8_t> bytes);

}  // namespace vat
