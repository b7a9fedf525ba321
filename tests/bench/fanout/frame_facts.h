#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vat::bench {

/// What a viewer under load reads of a frame's header.
struct FrameFacts {
  std::uint32_t number = 0;
  bool is_key = false;
  double published = 0;  ///< [s since 1970]
};

/// `start`: the frame's first bytes, its header at least. Throws std::runtime_error where that is
/// not one of ours.
FrameFacts frame_facts(std::string_view start);

/// The message that acknowledges the frame.
std::string acknowledgement(const FrameFacts& facts);

}  // namespace vat::bench
