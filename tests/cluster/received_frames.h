#pragma once

#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "protocol/client/client.h"

namespace vat::test {

/// Frames that a client has received.
struct Received {
  std::atomic<int> count = 0;
  std::mutex mutex;
  std::uint64_t tick = 0;  // of the last one, as the next members
  double max_error = 0;
  std::map<std::string, std::vector<Vec3>> positions;
  bool has_speed = false;

  void note(const client::Frame& frame) {
    const std::lock_guard lock(mutex);
    tick = frame.tick;
    max_error = frame.max_error;
    for (const auto& body : frame.bodies) {
      positions[std::string(body.name)].assign(body.positions.begin(), body.positions.end());
      has_speed = has_speed || !body.speed.empty();
    }
    ++count;
  }
  client::Handlers handlers() {
    client::Handlers handlers;
    handlers.on_frame = [this](const client::Frame& frame) { note(frame); };
    return handlers;
  }
};

/// Compares the last frames of a viewer at the owner and of a viewer at a relay. The caller must
/// hold both locks.
inline void expect_same_positions(const Received& direct, const Received& relayed) {
  ASSERT_FALSE(direct.positions.empty());
  ASSERT_EQ(direct.positions.size(), relayed.positions.size());
  for (const auto& [name, positions] : direct.positions) {
    const std::vector<Vec3>& others = relayed.positions.at(name);
    ASSERT_EQ(positions.size(), others.size()) << name;
    for (std::size_t i = 0; i < positions.size(); ++i) {
      // The relay's frame adds the error of the finest grid.
      ASSERT_LE((positions[i] - others[i]).cwiseAbs().maxCoeff(),
                direct.max_error + 1.1 * relayed.max_error)
          << name << ' ' << i;
    }
  }
}

}  // namespace vat::test
