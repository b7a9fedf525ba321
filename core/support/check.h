#pragma once

namespace vat {

/// Prints the failed condition with its file and line to stderr, and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace vat

/// Aborts if a condition is false that only a programming error can violate. Active in every build.
#define VAT_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::vat::check_failed(#condition, __FILE__, __LINE__))

/// Like VAT_CHECK, for inner loops. If NDEBUG is defined, the condition is compiled but not
/// evaluated.
#ifdef NDEBUG
#define VAT_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define VAT_ASSERT(condition) VAT_CHECK(condition)
#endif
