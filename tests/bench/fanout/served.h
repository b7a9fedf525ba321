#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vat::bench {

/// A tick, as the log tells of it.
struct TickTimes {
  double seconds = 0;   ///< that its steps took
  double publish = 0;   ///< [s] that publishing its state took
  double lateness = 0;  ///< [s]
};

/// A running `vat serve`, and what the system and its metrics tell of it.
class Served {
 public:
  /// Starts `program` with `arguments` after "serve", and waits for its URL. Throws
  /// std::runtime_error where that does not come. The server's log goes to the file `log`, if there
  /// is one, to standard error otherwise.
  Served(const std::string& program, const std::vector<std::string>& arguments,
         const std::string& log = {});
  ~Served();
  Served(const Served&) = delete;
  Served& operator=(const Served&) = delete;

  std::uint16_t port() const { return port_; }
  /// Spent since the start by all threads, and by those alone that make and send frames.
  double processor_seconds() const;
  double delivery_seconds() const;
  std::uint64_t resident_bytes() const;
  /// The samples of /metrics by name and labels, as they are written there.
  std::map<std::string, double> metrics() const;
  /// [bytes] of the log so far.
  std::size_t log_size() const;
  /// The ticks that the log, of level debug, tells of after its first `begin` bytes.
  std::vector<TickTimes> ticks_since(std::size_t begin) const;

 private:
  int process_ = -1;
  int output_ = -1;
  std::string log_;
  std::uint16_t port_ = 0;
};

}  // namespace vat::bench
