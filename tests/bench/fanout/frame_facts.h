#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace vat::bench {

/// Fields of a frame's header that a viewer under load reads.
struct FrameFacts {
  std::uint32_t number = 0;
  bool is_key = false;
  double published = 0;  ///< [s since 1970]
};

/// Reads the header. `start` contains at least the frame's header. Throws std::runtime_error if it
/// is invalid.
FrameFacts frame_facts(std::string_view start);

/// Returns the message that acknowledges the frame.
std::string acknowledgement(const FrameFacts& facts);

}  // namespace vat::bench
