#pragma once

/// 1 if the heap is the system's, 0 in builds in which a sanitizer replaces it. The latter exclude
/// tests of the heap.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VAT_HAS_SYSTEM_ALLOCATOR 0
#else
#define VAT_HAS_SYSTEM_ALLOCATOR 1
#endif
