#pragma once

#include <gtest/gtest.h>
#include <openssl/evp.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "server/history/recording.h"
#include "server/http/downloads.h"
#include "tests/server/fixture/session_fixture.h"
#include "tests/support/temporary_folder.h"

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
class ReplaySession : public testing::Test {
 protected:
  ReplaySession() : catalogue_(make_catalogue()), server_(catalogue_, settings()) {
    EXPECT_TRUE(server_.create_session("first", to_scene(mixed_scene_text())).ok());
    ann_.emplace(server_, 1);
    ann_->result("session.join", {{"name", "Ann"}});
    ann_->result("control.pause");
    ann_->result("control.reset");
    position_ = ann_->result("session.hash").at("position");
    first_ = position_;
  }
  void TearDown() override { ann_->disconnect(); }

  /// Runs the session and notes the hash of every position. The session ends at tick 11 of its
  /// second run.
  void live() {
    note();
    step(3);
    const Json grab =
        ann_->result("grab.start", {{"body", 2}, {"particle", 0}, {"target", {0.5, 0.5, 0.8}}});
    note();
    step(4);
    ann_->result("grab.end", {{"grab", grab.at("grab")}});
    ann_->result("world.set_gravity", {{"gravity", {1, 0, -5}}});
    note();
    step(5);
    ann_->result("control.reset");
    note();
    step(11);
  }
  void step(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      ann_->result("control.step");
      ++position_;
      note();
    }
  }
  void note() { hashes_[position_] = ann_->result("session.hash").at("hash"); }

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

  std::string exported() {
    const std::string path = ann_->result("recording.export").at("path");
    return server_.downloads().take(path, server_.clock().now())->content;
  }
  static Recording read(const std::string& bytes) {
    return read_recording({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()})
        .value();
  }
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
      seek(position);
      ASSERT_EQ(hash(), expected) << position;
    }
  }

 private:
  ServerSettings settings() const {
    ServerLimits limits = unhurried_limits();
    limits.max_particles = kMaxParticlesOfSession;
    return test_settings(limits, folder_.file("data"));
  }

 protected:
  const TemporaryFolder folder_;
  const Catalogue catalogue_;
  TestServer server_;
  std::optional<TestClient> ann_;
  std::optional<TestClient> bob_;
  Json joined_;
  std::uint64_t first_ = 0;
  std::uint64_t position_ = 0;
  std::map<std::uint64_t, std::string> hashes_;
};

}  // namespace vat::test
