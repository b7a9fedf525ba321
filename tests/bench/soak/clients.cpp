#include "tests/bench/soak/clients.h"

#include <chrono>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>
#include <vector>

#include "tests/bench/soak/caller.h"
#include "tests/bench/soak/rubbish.h"

namespace vat::bench {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

const Json kBall = Json::parse(R"({"name": "more", "kind": "rigid", "material": "wood",
  "spacing": 0.1, "shape": {"type": "sphere", "radius": 0.1}, "position": [0.5, 0.5, 0.8]})");

class Client {
 public:
  Client(const SoakPlace& place, std::uint32_t seed, Tally& tally)
      : place_(place), chance_(seed), tally_(tally), rubbish_(seed) {}

  /// Joins, unless it has joined already, and reads frames.
  void enter() {
    if (caller_) return;
    caller_.emplace(place_.port, tally_);
    Json params{{"session", place_.session}};
    if (!resume_.empty()) params["resume"] = std::exchange(resume_, "");
    joined_ = caller_->result("session.join", params);
    ++tally_.joins;
    caller_->result("frames.subscribe", {{"max_error", 1e-3}});
  }
  void steady() {
    enter();
    give_command(below(10));
    caller_->call(one_of({"session.hash", "session.stats", "presence.list", "session.list"}));
    caller_->read_for(milliseconds(20 + below(60)));
  }
  void grab() {
    enter();
    const Json held = caller_->call(
        "grab.start", {{"body", 1 + below(3)}, {"particle", 0}, {"target", somewhere()}});
    if (held.contains("result")) {
      const Json grab = held["result"]["grab"];
      for (int i = below(15); i > 0; --i) {
        caller_->call("grab.move", {{"grab", grab}, {"target", somewhere()}});
        caller_->read_for(10ms);
      }
      if (below(4) == 0) return break_off();
      caller_->call("grab.end", {{"grab", grab}});
    }
    caller_->read_for(milliseconds(20 + below(80)));
  }
  void come_and_go() {
    enter();
    caller_->call("session.hash");
    caller_->read_for(milliseconds(below(300)));
    if (below(100) == 0) take_recording();
    switch (below(4)) {
      case 0:
        caller_->result("session.leave");
        break;
      case 1:
        make_session();
        break;
      case 2:
        caller_->close();
        break;
      default:;  // leaves without a message
    }
    caller_.reset();
    std::this_thread::sleep_for(milliseconds(below(100)));
  }
  void stall() {
    enter();
    caller_->read_for(milliseconds(below(300)));
    ++tally_.stalls;
    caller_->read(false);
    std::this_thread::sleep_for(milliseconds(200 + below(2500)));
    if (below(2) == 0) return caller_.reset();
    caller_->read(true);
    caller_->call("session.hash");
  }
  /// The next round connects again.
  void lose_connection() {
    ++tally_.closed;
    caller_.reset();
  }
  /// Sends moves and queries, and reads only occasionally.
  void flood() {
    enter();
    for (int i = 0; i < 300; ++i) {
      ++tally_.flood;
      if (i % 2 == 0) {
        caller_->send("world.set_gravity", {{"gravity", {0, 0, -9.81 - 0.01 * below(10)}}});
      } else {
        caller_->send("session.hash", Json::object());
      }
    }
    drain();
    if (caller_ && below(20) == 0) caller_.reset();
    std::this_thread::sleep_for(milliseconds(below(50)));
  }
  void talk_rubbish() {
    if (below(10) == 0) {
      send_raw(place_.port, rubbish_.bytes());
      ++tally_.garbage;
    }
    if (!caller_) {
      caller_.emplace(place_.port, tally_);
      if (below(2) == 0) caller_->send("session.join", {{"session", place_.session}});
    }
    for (int i = 0; i < 20; ++i) {
      ++tally_.garbage;
      if (below(5) == 0) {
        caller_->connection().send_binary(rubbish_.bytes());
      } else {
        caller_->connection().send_text(rubbish_.text());
      }
    }
    drain();
    if (caller_ && below(30) == 0) caller_.reset();
    std::this_thread::sleep_for(milliseconds(below(200)));
  }

 private:
  int below(int end) { return std::uniform_int_distribution(0, end - 1)(chance_); }
  std::string one_of(const std::vector<std::string>& words) {
    return words[static_cast<std::size_t>(below(static_cast<int>(words.size())))];
  }
  Json somewhere() { return {0.1 * below(10), 0.1 * below(10), 0.1 * below(10)}; }

  void give_command(int which) {
    switch (which) {
      case 0:
        caller_->call("control.reset");
        break;
      case 1:
        caller_->call("control.pause");
        caller_->call("control.step", {{"ticks", 1 + below(3)}});
        break;
      case 2:
        caller_->call("control.set_speed", {{"speed", 0.5 + 0.1 * below(10)}});
        break;
      case 3:
        caller_->call("world.apply_force",
                      {{"body", 1 + below(3)}, {"force", {0, 0, below(10)}}, {"duration", 0.2}});
        break;
      case 4:
        if (const Json added = caller_->call("world.add_body", {{"body", kBall}});
            added.contains("result")) {
          caller_->call("world.remove_body", {{"body", added["result"]["body"]}});
        }
        break;
      default:
        caller_->call("control.play");
    }
  }
  /// Disconnects while it grabs a body. It may later resume as the same participant.
  void break_off() {
    if (below(2) == 0) resume_ = joined_.at("resume");
    caller_.reset();
  }
  void make_session() {
    const Json made = caller_->call("session.create", {{"name", "own"}, {"scene", "pool"}});
    if (!made.contains("result")) return;
    caller_->result("session.join", {{"session", made["result"]["session"]}});
    ++tally_.joins;
    caller_->read_for(100ms);
    caller_->result("session.close", {{"session", made["result"]["session"]}});
  }
  void take_recording() {
    const Json exported = caller_->call("recording.export");
    if (!exported.contains("result")) return;
    const Json answer = fetch(place_.port, exported["result"]["path"]);
    if (answer["size"] != exported["result"]["bytes"]) {
      throw std::runtime_error("a recording differs from its description: " + answer.dump());
    }
    ++tally_.recordings;
  }
  /// Reads all messages up to the end of the connection.
  void drain() {
    while (const auto message = caller_->next(steady_clock::now() + 5ms)) {
      if (message->kind == client::Message::Kind::closed) return lose_connection();
    }
  }

  const SoakPlace place_;
  std::mt19937 chance_;
  Tally& tally_;
  std::optional<Caller> caller_;
  Json joined_;
  std::string resume_;
  Rubbish rubbish_;
};

void play_round(Client& client, Manner manner) try {
  switch (manner) {
    case Manner::steady:
      return client.steady();
    case Manner::grabbing:
      return client.grab();
    case Manner::restless:
      return client.come_and_go();
    case Manner::stalling:
      return client.stall();
    case Manner::flooding:
      return client.flood();
    case Manner::rubbish:
      return client.talk_rubbish();
  }
} catch (const ClosedAsTooSlow&) {
  client.lose_connection();
}

}  // namespace

void run_soak_client(Manner manner, const SoakPlace& place, std::uint32_t seed,
                     const std::atomic<bool>& stop, Tally& tally) {
  constexpr const char* kNames[] = {"steady",   "grabbing", "restless",
                                    "stalling", "flooding", "rubbish"};
  try {
    Client client(place, seed, tally);
    while (!stop) play_round(client, manner);
  } catch (const std::exception& fault) {
    tally.add_fault(std::string(kNames[static_cast<int>(manner)]) + " client of " + place.session +
                    ": " + fault.what());
  }
}

}  // namespace vat::bench
