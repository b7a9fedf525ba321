#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vat::bench {

/// A tick in the server's log.
struct TickTimes {
  double seconds = 0;   ///< duration of its steps
  double publish = 0;   ///< [s] duration of publishing its state
  double lateness = 0;  ///< [s]
};

/// Returns the processor time of a process since its start [s].
double processor_seconds_of(int process);

/// A running `vat serve`, with figures of the system and of its metrics.
class Served {
 public:
  /// Starts `program` with `arguments` after "serve", and waits for its URL. Throws
  /// std::runtime_error if there is no URL. The server writes its log to the file `log` if it is
  /// given, otherwise to standard error.
  Served(const std::string& program, const std::vector<std::string>& arguments,
         const std::string& log = {});
  ~Served();
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::uint16_t port() const { return port_; }
  /// Returns the processor time since the start: of all threads, and of the threads that make and
  /// send frames.
  double processor_seconds() const;
  double delivery_seconds() const;
  /// Returns the processor time of the threads with this name.
  double seconds_of_thread(const std::string& name) const;
  std::uint64_t resident_bytes() const;
  /// Returns the samples of /metrics by name and labels, as they are written there.
  std::map<std::string, double> metrics() const;
  /// Returns the size of the log [bytes].
  std::size_t log_size() const;
  /// Returns the ticks in the log after its first `begin` bytes. Its level must be debug.
  std::vector<TickTimes> ticks_since(std::size_t begin) const;

 private:
  int process_ = -1;
  int output_ = -1;
  std::string log_;
  std::uint16_t port_ = 0;
};

}  // namespace vat::bench
