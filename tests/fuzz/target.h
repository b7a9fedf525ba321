#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/check.h"

/// The function that the fuzzer calls with each input. It returns 0. A detected fault ends the
/// process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vat::fuzz {

inline std::string_view to_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace vat::fuzz
