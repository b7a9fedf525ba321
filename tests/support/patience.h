#pragma once

namespace vat::test {

/// Factor of time limits in this build, relative to an ordinary build. It exceeds 1 only with a
/// sanitizer. tests/CMakeLists.txt sets it.
inline constexpr int kSlowdown = VAT_SLOWDOWN;

}  // namespace vat::test
