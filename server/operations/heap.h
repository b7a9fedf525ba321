#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>

namespace vat {

/// Returns the number of used heap bytes, or 0 if a sanitizer replaces the allocator.
std::size_t heap_in_use();

/// Configures the allocator. A small number of arenas allows other threads to reuse free memory.
/// Large blocks have separate mappings, which are released immediately. Must be called before
/// threads start.
void prepare_heap();

/// Periodic release of free memory to the system. Without the release, each arena retains its
/// greatest size, and memory grows for hours if clients do not read. Each release takes some
/// milliseconds.
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
