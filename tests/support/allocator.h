#pragma once

/// 1 if the heap is the system's, 0 in builds where a sanitizer has its own allocator: tests of
/// the heap are not part of those.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VAT_HAS_SYSTEM_ALLOCATOR 0
#else
#define VAT_HAS_SYSTEM_ALLOCATOR 1
#endif
