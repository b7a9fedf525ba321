#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tests/bench/fanout/viewer.h"

namespace vat::bench {

using ViewerCounts = std::array<std::size_t, kViewerKinds>;
using LoadSightings = std::array<Sightings, kViewerKinds>;

/// Viewers in a separate process, so that their cost is not counted as the server's. It must be
/// started while this program has one thread.
class LoadProcess {
 public:
  /// Connects the viewers. Throws std::runtime_error if the process cannot be started.
  LoadProcess(const LoadSettings& settings, const ViewerCounts& viewers, std::uint32_t seed);
  ~LoadProcess();
  LoadProcess(const LoadProcess&) = delete;
  LoadProcess& operator=(const LoadProcess&) = delete;

  /// Waits until every viewer that subscribes has received a frame. Throws after one minute, or if
  /// the process fails.
  void wait_ready();
  /// Starts the measurement.
  void begin();
  /// Returns the measurements since begin().
  LoadSightings tell();
  /// Returns the measurements since begin(), and ends the process.
  LoadSightings end();

 private:
  LoadSightings ask(char command);

  int process_ = -1;
  int to_ = -1;
  int from_ = -1;
};

}  // namespace vat::bench
