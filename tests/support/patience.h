#pragma once

namespace vat::test {

/// How many times as long as in an ordinary build what is done may take here: more than once only
/// under a sanitizer, which makes programs so much slower. tests/CMakeLists.txt has the values.
inline constexpr int kSlowdown = VAT_SLOWDOWN;

}  // namespace vat::test
