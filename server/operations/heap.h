#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>

namespace vat {

/// Returns the used bytes of the heap, or 0 if a sanitizer replaces the allocator.
std::size_t heap_in_use();

/// Configures the allocator: few arenas, so that free memory can be reused by other threads, and
/// separate mappings for large blocks, which are returned when they are freed. Must be called
/// before threads start.
void prepare_heap();

/// Returns free memory to the system at intervals, while it exists and its context runs. Without
/// this, each arena keeps its greatest size, and the server grows for hours if clients do not read.
/// Each return takes some milliseconds.
class MemoryReturn {
 public:
  static constexpr std::chrono::milliseconds kInterval{10'000};

  explicit MemoryReturn(boost::asio::io_context& io, std::chrono::milliseconds interval = kInterval)
      : timer_(io), interval_(interval) {
    wait();
  }

 private:
  void wait();

  boost::asio::steady_timer timer_;
  const std::chrono::milliseconds interval_;
};

}  // namespace vat
