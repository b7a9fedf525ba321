#pragma once

#include <cstddef>
#include <cstdint>

/// Sizes, offsets and codes of PROTOCOL.md, "Frames".
namespace vat::frame_layout {

inline constexpr std::uint32_t kMagic = 0x46544156;  // "VATF"
inline constexpr std::uint8_t kVersion = 1;
inline constexpr std::uint8_t kKeyFrame = 1;

inline constexpr std::uint16_t kPlayingFlag = 1;
inline constexpr std::uint16_t kSlowFlag = 2;

inline constexpr std::size_t kHeaderSize = 96;
inline constexpr std::size_t kSequenceOffset = 12;
inline constexpr std::size_t kDroppedOffset = 48;
inline constexpr std::size_t kRealTimeFactorOffset = 88;

inline constexpr std::size_t kBlockHeaderSize = 12;
inline constexpr std::uint8_t kGridEncoding = 1;
inline constexpr std::uint8_t kPoseEncoding = 2;
inline constexpr std::uint8_t kOffsetEncoding = 3;

inline constexpr std::size_t kGridPositionSize = 6;  // three u16
inline constexpr std::size_t kPoseSize = 40;
inline constexpr std::size_t kOffsetSize = 24;

inline constexpr double kMaxGridCoordinate = 65535;

}  // namespace vat::frame_layout
