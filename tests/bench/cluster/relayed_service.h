#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tests/bench/fanout/served.h"
#include "tests/cluster/nats_servers.h"

namespace vat::bench {

/// An owner of the session "s1", and two relays, as processes on this machine.
class RelayedService {
 public:
  static constexpr std::size_t kRelays = 2;

  /// Starts `program` with the scene. Throws std::runtime_error.
  RelayedService(const std::string& program, const std::filesystem::path& folder,
                 const std::string& scene, std::size_t clients);

  const Served& owner() const { return *nodes_.front(); }
  std::uint16_t relay_port(std::size_t relay) const { return nodes_.at(1 + relay)->port(); }
  /// Returns the processor time of the owner, of both relays, and of NATS [s].
  std::array<double, 3> processor_seconds() const;

 private:
  test::NatsServers nats_{1};
  std::vector<std::unique_ptr<Served>> nodes_;
};

/// Calls `measure` with each number of clients, and prints the progress. After an exception, prints
/// an error of the command and returns nothing.
template <class Row>
std::optional<std::vector<Row>> measure_each(const char* command,
                                             const std::vector<std::size_t>& counts,
                                             const std::function<Row(std::size_t)>& measure) {
  std::vector<Row> rows;
  for (const std::size_t count : counts) {
    std::cout << count << " clients ..." << std::endl;
    try {
      rows.push_back(measure(count));
    } catch (const std::exception& error) {
      std::cerr << command << ": " << error.what() << '\n';
      return {};
    }
  }
  return rows;
}

}  // namespace vat::bench
