#include "tests/bench/faults/fault_clients.h"

#include <chrono>
#include <optional>
#include <random>
#include <stdexcept>
#include <thread>

#include "tests/bench/soak/caller.h"
#include "tests/bench/soak/rubbish.h"

namespace vat::bench {
namespace {

using namespace std::chrono_literals;
using std::chrono::milliseconds;
using std::chrono::steady_clock;

constexpr milliseconds kBetweenFaultCommands{200};
constexpr const char* kInternalErrorText = "-32603";

double now() {
  return std::chrono::duration<double>(steady_clock::now().time_since_epoch()).count();
}

class FaultClient {
 public:
  FaultClient(const FaultPlace& place, std::uint32_t name, LifeNotes& notes, Tally& tally)
      : place_(place), name_(name), chance_(name), notes_(notes), tally_(tally), rubbish_(name) {}

  void command() {
    if (!caller_) enter(place_.admin);
    const auto next = steady_clock::now() + kBetweenFaultCommands;
    give_command(++round_);
    const Json state = caller_->call("session.list");
    for (const Json& session : state.at("result").at("sessions")) {
      if (session.at("session") == place_.session) {
        notes_.add_tick(place_.session, now(), session.at("tick"));
      }
    }
    while (steady_clock::now() < next) {
      caller_->read_for(std::chrono::duration_cast<milliseconds>(next - steady_clock::now()) + 1ms);
    }
  }
  void read_slowly() {
    if (!caller_) watch();
    caller_->read_for(1ms);
    caller_->read(false);
    std::this_thread::sleep_for(200ms);
    caller_->read(true);
  }
  void be_silent() {
    if (!caller_) {
      watch();
      caller_->read(false);
    }
    std::this_thread::sleep_for(100ms);
  }
  void talk_rubbish() {
    if (below(10) == 0) send_raw(place_.port, rubbish_.bytes());
    if (!caller_) enter(place_.viewer);
    for (int i = 0; i < 20; ++i) {
      ++tally_.garbage;
      if (below(5) == 0) {
        caller_->connection().send_binary(rubbish_.bytes());
      } else {
        caller_->connection().send_text(rubbish_.text());
      }
    }
    caller_->read_for(milliseconds(50 + below(200)));
  }
  void come_and_go() {
    watch();
    caller_->read_for(milliseconds(50 + below(300)));
    caller_.reset();
    ++notes_.reconnects;
    std::this_thread::sleep_for(milliseconds(below(200)));
  }
  void flood() {
    if (!caller_) enter(place_.viewer);
    for (int i = 0; i < 60; ++i) {
      ++tally_.flood;
      caller_->send(i % 2 == 0 ? "session.hash" : "presence.list", Json::object());
    }
    caller_->read_for(milliseconds(50 + below(100)));
  }
  void send_wrong_tokens() {
    Caller caller(place_.port, tally_);
    for (int i = 0; i < 3; ++i) {
      const Json reply = caller.call("access.enter", {{"token", "wrong" + std::to_string(name_)}});
      ++(reply.contains("error") ? notes_.strangers_refused : notes_.strangers_admitted);
    }
  }

  /// Ends the connection, which may be closed already.
  void leave() { caller_.reset(); }

 private:
  int below(int end) { return std::uniform_int_distribution(0, end - 1)(chance_); }

  void enter(const std::string& token) {
    caller_.emplace(place_.port, tally_);
    caller_->result("access.enter", {{"token", token}});
    caller_->result("session.join", {{"session", place_.session}});
    ++tally_.joins;
  }
  void watch() {
    enter(place_.viewer);
    caller_->result("frames.subscribe", {{"max_error", 1e-3}});
  }

  /// Returns a unique number between 0 and 1000.
  double mark() const { return 1e-3 * (name_ % 1'000'000) + 1e-9 * static_cast<double>(round_); }

  void give_command(std::uint64_t round) {
    switch (round % 3) {
      case 0:
        attempt("world.set_gravity", {{"gravity", {1e-3 * mark(), 0, -9.81}}});
        break;
      case 1:
        attempt("world.apply_force", {{"body", 2}, {"force", {0, 0, mark()}}, {"duration", 0.02}});
        break;
      default:
        add_and_remove();
    }
  }
  void add_and_remove() {
    const Json ball{{"name", "ball " + std::to_string(mark())},
                    {"kind", "rigid"},
                    {"material", "wood"},
                    {"spacing", 0.1},
                    {"shape", {{"type", "sphere"}, {"radius", 0.1}}},
                    {"position", {0.5, 0.5, 0.8}}};
    const std::optional<Json> added = attempt("world.add_body", {{"body", ball}});
    if (added) attempt("world.remove_body", {{"body", added->at("body")}});
  }
  /// Notes a successful command.
  std::optional<Json> attempt(const std::string& method, const Json& params) {
    const Json reply = caller_->call(method, params);
    if (reply.contains("result")) {
      notes_.add_answered(place_.session, command_text(method, params.dump()));
      return reply.at("result");
    }
    if (reply["error"]["data"].value("limit", "") == "memory_bytes") ++notes_.memory_refusals;
    return {};
  }

  const FaultPlace place_;
  const std::uint32_t name_;
  std::mt19937 chance_;
  LifeNotes& notes_;
  Tally& tally_;
  std::optional<Caller> caller_;
  Rubbish rubbish_;
  std::uint64_t round_ = 0;
};

void play_round(FaultClient& client, FaultManner manner) {
  switch (manner) {
    case FaultManner::commanding:
      return client.command();
    case FaultManner::slow:
      return client.read_slowly();
    case FaultManner::silent:
      return client.be_silent();
    case FaultManner::malformed:
      return client.talk_rubbish();
    case FaultManner::reconnecting:
      return client.come_and_go();
    case FaultManner::flooding:
      return client.flood();
    case FaultManner::stranger:
      return client.send_wrong_tokens();
  }
}

/// Returns whether the server may end the connection of such a client.
bool may_be_closed(FaultManner manner) {
  return manner != FaultManner::commanding && manner != FaultManner::reconnecting;
}

}  // namespace

void LifeNotes::add_answered(const std::string& session, const std::string& command) {
  const std::lock_guard lock(mutex_);
  answered_[session].push_back(command);
}

void LifeNotes::add_tick(const std::string& session, double time, double tick) {
  const std::lock_guard lock(mutex_);
  Ticks& ticks = ticks_[session];
  if (ticks.first_time == 0) {
    ticks.first_time = time;
    ticks.first = tick;
  }
  ticks.last_time = time;
  ticks.last = tick;
}

std::map<std::string, std::vector<std::string>> LifeNotes::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}

std::map<std::string, double> LifeNotes::tick_rates() const {
  const std::lock_guard lock(mutex_);
  std::map<std::string, double> rates;
  for (const auto& [session, ticks] : ticks_) {
    if (ticks.last_time > ticks.first_time) {
      rates[session] = (ticks.last - ticks.first) / (ticks.last_time - ticks.first_time);
    }
  }
  return rates;
}

std::string command_text(const std::string& method, const std::string& params) {
  return method + ' ' + params;
}

void run_fault_client(FaultManner manner, const FaultPlace& place, std::uint32_t name,
                      LifeNotes& notes, Tally& tally) {
  FaultClient client(place, name, notes, tally);
  while (!notes.ends) {
    try {
      play_round(client, manner);
    } catch (const std::exception& fault) {
      client.leave();
      if (notes.ends) return;
      const std::string text = fault.what();
      if (may_be_closed(manner) && text.find(kInternalErrorText) == std::string::npos) {
        ++tally.closed;
        std::this_thread::sleep_for(100ms);
      } else {
        tally.add_fault(place.session + ": " + text);
        return;
      }
    }
  }
}

}  // namespace vat::bench
