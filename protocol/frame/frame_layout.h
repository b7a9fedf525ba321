#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "protocol/frame/grid_frame.h"

/// Sizes, offsets and codes of the binary format (FRAMES.md).
namespace vat::frame_layout {

inline constexpr std::uint32_t kMagic = 0x46544156;  // "VATF"
inline constexpr std::uint8_t kVersion = 2;
inline constexpr std::uint8_t kKeyFrame = 1;
inline constexpr std::uint8_t kDeltaFrame = 2;

inline constexpr std::uint8_t kPlayingFlag = 1;
inline constexpr std::uint8_t kSlowFlag = 2;
inline constexpr int kDetailShift = 2;
inline constexpr std::uint8_t kRegionFlag = 16;
/// Flag of key frames: the scale contains a fourth quantum, for accelerations.
inline constexpr std::uint8_t kAccelerationFlag = 32;
inline constexpr std::uint8_t kKnownFlags = 31;  // flags that all frames can contain

inline constexpr std::size_t kTypeOffset = 5;
inline constexpr std::size_t kNumberOffset = 12;
inline constexpr std::size_t kHeaderSize = 52;
inline constexpr std::size_t kScaleSize = 56;  // [bytes] in key frames, after the header
/// Number of quanta in the scale, without the optional fourth quantum.
inline constexpr std::size_t kScaleAttributes = 3;

/// Probabilities that a block has changed, in units of 1/4096. Element 0 applies after an unchanged
/// block, element 1 after a changed block.
inline constexpr std::array<std::uint32_t, 2> kChangeChances{256, 3584};

inline constexpr double kMaxGridCoordinate = 65535;
inline constexpr std::int32_t kMaxAttribute = 1 << 20;
inline constexpr std::int32_t kMaxPlace = 1 << 28;
inline constexpr std::uint8_t kMinOrientationBits = 4;
inline constexpr std::uint8_t kMaxOrientationBits = 27;

/// Returns whether blocks of this kind contain the attribute in frames of this scale.
inline bool has_attribute(GridBlock::Kind kind, const FrameScale& scale, std::size_t attribute) {
  if (!(scale.attribute_quanta[attribute] > 0)) return false;
  if (kind == GridBlock::Kind::liquid) return true;
  return kind == GridBlock::Kind::deformable &&
         (attribute == static_cast<std::size_t>(FrameAttribute::speed) ||
          attribute == static_cast<std::size_t>(FrameAttribute::acceleration));
}

/// Returns whether frames of this scale have kAccelerationFlag and the fourth quantum.
inline bool has_acceleration(const FrameScale& scale) {
  return scale.attribute_quanta[static_cast<std::size_t>(FrameAttribute::acceleration)] > 0;
}

}  // namespace vat::frame_layout
