#pragma once

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <variant>
#include <vector>

#include "server/access/token.h"
#include "server/cluster/saved/cluster_scenes.h"
#include "server/cluster/saved/cluster_states.h"
#include "tests/cluster/nats_servers.h"
#include "tests/support/manual_clock.h"

namespace vat::test {

inline constexpr SavedStateLimits kManyStates{100, 100'000'000, 100'000'000};
inline constexpr SavedSceneLimits kManyScenes{100, 1'000'000, 100, 1'000'000};

inline SavedState make_state(const std::string& name, std::size_t bytes = 10) {
  SavedState state;
  state.entry = {name, "Ada", 1.5, 7, 0.25, 0xfedcba9876543210, bytes};
  state.fields = "{}";
  for (std::size_t i = 2; i < bytes; ++i) {
    state.state.push_back(static_cast<std::uint8_t>(i * 31 >> 3));
  }
  return state;
}

inline SavedScene make_scene(const std::string& name, const std::string& address = "10.0.0.1",
                             std::size_t bytes = 10) {
  SavedScene scene;
  scene.entry = {name, "Title", "Text", "Ada", 1.5, bytes};
  scene.address = address;
  scene.key = hash_of_token(name);
  scene.scene = std::string(bytes, 'x');
  return scene;
}

template <class Entry>
std::vector<std::string> names_of(const std::vector<Entry>& entries) {
  std::vector<std::string> names;
  for (const Entry& entry : entries) names.push_back(entry.name);
  return names;
}

inline std::string name_of(const std::optional<LimitExcess>& excess) {
  return excess ? std::string(excess->limit) : "none";
}

/// Returns the result of a write as text.
inline std::string text_of(const std::variant<SceneChange, LimitExcess>& written) {
  if (const auto* excess = std::get_if<LimitExcess>(&written)) return std::string(excess->limit);
  const SceneChange change = std::get<SceneChange>(written);
  return change == SceneChange::added      ? "added"
         : change == SceneChange::replaced ? "replaced"
         : change == SceneChange::refused  ? "refused"
                                           : "?";
}

inline bool permit(const SceneKey&) {
  return true;
}

inline bool forbid(const SceneKey&) {
  return false;
}

/// Lease of a node.
struct OpenGate final : SendGate {
  bool is_open() const override { return open; }
  bool open = true;
};

/// The saved data as a node of a cluster uses it.
struct SavingNode {
  SavingNode(const NatsServers& servers, const Clock& clock)
      : connection({servers.urls(), "test", {}, {}, {}, {}}), store(connection, gate, clock) {}

  NatsConnection connection;
  OpenGate gate;
  SavedStore store;
  std::set<std::string> ended;
  ClusterStates states{store,
                       [this](const std::string& session) { return !ended.contains(session); }};
  ClusterScenes scenes{store};
};

class SavedData : public testing::Test {
 protected:
  /// Returns the subjects of the stored contents.
  std::vector<std::string> contents() {
    return Stream(a.connection, {"vat-saved", "vat.saved.>", Stream::Milliseconds(0), 0, {}})
        .subjects("vat.saved.>");
  }

  ManualClock clock;
  NatsServers servers{1};
  SavingNode a{servers, clock};
  SavingNode b{servers, clock};
};

}  // namespace vat::test
