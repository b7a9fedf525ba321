#pragma once

namespace vat {

/// Prints the failed condition with its place to stderr and aborts.
[[noreturn]] void check_failed(const char* condition, const char* file, int line);

}  // namespace vat

/// A condition that only a mistake in this program can break; kept in every build.
#define VAT_CHECK(condition) \
  ((condition) ? static_cast<void>(0) : ::vat::check_failed(#condition, __FILE__, __LINE__))

/// The same, in inner loops: compiled out where NDEBUG is defined.
#ifdef NDEBUG
#define VAT_ASSERT(condition) static_cast<void>(0)
#else
#define VAT_ASSERT(condition) VAT_CHECK(condition)
#endif
