#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "tests/bench/fanout/viewer.h"

namespace vat::bench {

using ViewerCounts = std::array<std::size_t, kViewerKinds>;
using LoadSightings = std::array<Sightings, kViewerKinds>;

/// Viewers in a process of their own, so that what they cost is not the server's. It must be
/// started while this program has one thread.
class LoadProcess {
 public:
  /// Connects the viewers at once. Throws std::runtime_error where there is no process.
  LoadProcess(const LoadSettings& settings, const ViewerCounts& viewers, std::uint32_t seed);
  ~LoadProcess();
  LoadProcess(const LoadProcess&) = delete;
  LoadProcess& operator=(const LoadProcess&) = delete;

  /// Waits until every viewer has got a frame. Throws where that takes longer than a minute, or
  /// the process fails.
  void wait_ready();
  /// What is seen from now on counts.
  void begin();
  /// What was seen since begin().
  LoadSightings tell();
  /// The same; ends the process.
  LoadSightings end();

 private:
  LoadSightings ask(char command);

  int process_ = -1;
  int to_ = -1;
  int from_ = -1;
};

}  // namespace vat::bench
