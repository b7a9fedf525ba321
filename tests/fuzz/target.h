#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "core/support/check.h"

/// What a fuzzer calls with each input; it must return 0, and anything it finds ends the process.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace vat::fuzz {

inline std::string_view to_text(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace vat::fuzz
