#pragma once

#include <openssl/evp.h>

#include "tests/server/replay/replay_fixture.h"

namespace vat::test {

inline std::string to_base64(const std::string& bytes) {
  std::string text(4 * ((bytes.size() + 2) / 3) + 1, '\0');
  const int length = EVP_EncodeBlock(reinterpret_cast<unsigned char*>(text.data()),
                                     reinterpret_cast<const unsigned char*>(bytes.data()),
                                     static_cast<int>(bytes.size()));
  text.resize(static_cast<std::size_t>(length));
  return text;
}

inline constexpr std::size_t kMaxParticlesOfSession = 5000;

/// A stored session `s1` in which Ann has sent commands, and a client that watches.
class ReplaySession : public ReplayTest {
 protected:
  ReplaySession() : ReplayTest(limits()) {
    position_ = client_->result("session.hash").at("position");
    first_ = position_;
  }
  static ServerLimits limits() {
    ServerLimits limits = unhurried_limits();
    limits.max_particles = kMaxParticlesOfSession;
    return limits;
  }

  /// Runs the session and notes the hash of every position. The session ends at tick 11 of its
  /// second run.
  void live() {
    note();
    step(3);
    const std::uint64_t grab = client_->grab(2);
    note();
    step(4);
    client_->result("grab.end", {{"grab", grab}});
    client_->result("world.set_gravity", {{"gravity", {1, 0, -5}}});
    note();
    step(5);
    client_->result("control.reset");
    note();
    step(11);
  }
  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      client_->result("control.step");
      ++position_;
      note();
    }
  }
  void note() { hashes_[position_] = client_->result("session.hash").at("hash"); }

  /// Opens the replay, lets `bob_` join it, and returns the result of replay.open.
  Json open(const Json& params = {{"session", "s1"}}) {
    bob_.emplace(server_, 2);
    // Opening the past of a session needs the controller role in it.
    if (params.contains("session")) bob_->result("session.join");
    const Json opened = bob_->result("replay.open", params);
    joined_ = bob_->result("session.join", {{"session", opened.at("session")}, {"name", "Bob"}});
    return opened;
  }
  Json seek(std::uint64_t position) {
    return bob_->result("replay.seek", {{"position", position}});
  }
  std::string hash() { return bob_->result("session.hash").at("hash"); }

  /// Uploads a file in parts of `part` bytes. Returns the reply to the last part.
  Json import(TestClient& client, const std::string& file, std::size_t part = 3'000'000) {
    Json last;
    for (std::size_t at = 0; at < file.size(); at += part) {
      Json params{
          {"size", file.size()}, {"offset", at}, {"data", to_base64(file.substr(at, part))}};
      if (at > 0) params["recording"] = last.at("recording");
      last = client.call("recording.import", params);
      if (!last.contains("result")) return last;
      last = last.at("result");
    }
    return last;
  }
  Json import(TestClient& client, const Recording& recording) {
    const std::vector<std::uint8_t> bytes = write_recording(recording);
    return import(client, std::string(bytes.begin(), bytes.end()));
  }
  /// Expects that the replay shows every noted state.
  void expect_states() {
    for (const auto& [position, expected] : hashes_) {
      EXPECT_EQ(seek(position).at("position"), position);
      ASSERT_EQ(hash(), expected) << position;
    }
  }

  std::optional<TestClient> bob_;
  Json joined_;
  std::uint64_t first_ = 0;
  std::uint64_t position_ = 0;
  std::map<std::uint64_t, std::string> hashes_;
};

}  // namespace vat::test
