#pragma once

#include <boost/asio/io_context.hpp>
#include <boost/asio/steady_timer.hpp>
#include <chrono>
#include <cstddef>

namespace vat {

/// What of the heap is in use; 0 where a sanitizer has taken the allocator's place. [bytes]
std::size_t heap_in_use();

/// Before there are threads: the allocator's arenas are few, so that free memory lies where the
/// next message wants it, and what is large is mapped by itself, and given back when it is free.
void prepare_heap();

/// Gives free memory back to the system from time to time, for as long as it lives and its context
/// runs. What waits for clients that do not read comes and goes in small pieces, on many threads;
/// left alone, the allocator keeps the most that each of its arenas has ever held, and a server
/// grows for hours. Takes some milliseconds of its thread each time.
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
