#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace vat::bench {

/// A running `vat serve`, and what the system and its metrics tell of it.
class Served {
 public:
  /// Starts `program` with `arguments` after "serve", and waits for its URL. Throws
  /// std::runtime_error where that does not come.
  Served(const std::string& program, const std::vector<std::string>& arguments);
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

 private:
  int process_ = -1;
  int output_ = -1;
  std::uint16_t port_ = 0;
};

}  // namespace vat::bench
