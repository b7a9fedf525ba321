#pragma once

namespace vat {

/// Prints the failed condition with its file and line to stderr, and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace vat

/// Aborts if `condition` is false, in every build. Only a programming error may make the condition
/// false.
#define VAT_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::vat::check_failed(#condition, __FILE__, __LINE__))

/// VAT_CHECK for inner loops. If NDEBUG is defined, the condition is compiled but not evaluated.
#ifdef NDEBUG
#define VAT_ASSERT(condition) static_cast<void>(sizeof((condition) ? 1 : 0))
#else
#define VAT_ASSERT(condition) VAT_CHECK(condition)
#endif
