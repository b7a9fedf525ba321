#include "tests/recovery/load.h"

#include <optional>
#include <stdexcept>
#include <utility>

#include "protocol/json_reader.h"
#include "tests/recovery/client.h"
#include "tests/support/wait.h"

namespace vat::test {
namespace {

/// The server has gone.
class Gone : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A client that waits for each answer.
class Caller {
 public:
  explicit Caller(std::uint16_t port) : client_(port) {
    if (!client_.is_connected()) throw Gone("no connection");
  }

  /// The result, or nothing where it is an error. Throws Gone.
  std::optional<Json> call(const std::string& method, const Json& params = Json::object()) {
    last_reply_ = client_.call(method, params);
    if (last_reply_.contains("closed")) throw Gone("closed");
    if (last_reply_.contains("error")) return {};
    return last_reply_.at("result");
  }
  Json result(const std::string& method, const Json& params = Json::object()) {
    auto result = call(method, params);
    if (!result) throw std::runtime_error(method + ": " + last_reply_.dump());
    return *std::move(result);
  }

 private:
  WaitingClient client_;
  Json last_reply_;
};

/// One client at work.
class Load {
 public:
  Load(std::uint16_t port, std::string session, std::uint64_t name, Told& told)
      : caller_(port), session_(std::move(session)), name_(name), told_(told) {}

  void run() {
    const Json joined = caller_.result("session.join", {{"session", session_}});
    body_ = joined.at("description").at("bodies").at(0).at("body");
    for (std::uint64_t round = 1;; ++round) {
      change(round);
      look();
    }
  }

 private:
  /// A number that nobody has used before.
  double mark(std::uint64_t round) const {
    return static_cast<double>(name_) + static_cast<double>(round) / 1048576;
  }

  void command(const std::string& method, const Json& params) {
    if (caller_.call(method, params)) told_.add(Answered{session_, method, params.dump()});
  }

  void change(std::uint64_t round) {
    const double number = mark(round);
    switch ((round + name_) % 6) {
      case 0:
        command("world.set_gravity", {{"gravity", {number * 1e-3, 0, -9.81}}});
        break;
      case 1:
        command("world.apply_force",
                {{"body", body_}, {"force", {0, number, 0}}, {"duration", 0.1}});
        break;
      case 2:
        hold(number);
        break;
      case 3:
        command("control.step", {{"ticks", 1 + round % 4}});
        break;
      case 4:
        command("control.play", Json::object());
        break;
      default:
        add_and_remove(number);
    }
  }

  void hold(double number) {
    const Json start{{"body", body_}, {"particle", 0}, {"target", {0.5, 0.5, number * 1e-3}}};
    const auto grab = caller_.call("grab.start", start);
    if (!grab) return;
    told_.add(Answered{session_, "grab.start", start.dump()});
    command("grab.move", {{"grab", grab->at("grab")}, {"target", {0.4, number * 1e-3, 0.5}}});
    command("grab.end", {{"grab", grab->at("grab")}});
  }

  void add_and_remove(double number) {
    const Json params{{"body",
                       {{"name", "ball " + std::to_string(number)},
                        {"kind", "rigid"},
                        {"material", "wood"},
                        {"spacing", 0.1},
                        {"shape", {{"type", "sphere"}, {"radius", 0.12}}},
                        {"position", {0.5, 0.5, 0.8}}}}};
    const auto added = caller_.call("world.add_body", params);
    if (!added) return;
    told_.add(Answered{session_, "world.add_body", params.dump()});
    command("world.remove_body", {{"body", added->at("body")}});
  }

  void look() {
    const Json state = caller_.result("session.hash");
    told_.add(Seen{session_, state.at("position"), state.at("hash")});
  }

  Caller caller_;
  const std::string session_;
  const std::uint64_t name_;
  Told& told_;
  int body_ = 0;
};

}  // namespace

void Told::add(Seen seen) {
  const std::lock_guard lock(mutex_);
  seen_.push_back(std::move(seen));
}
void Told::add(Answered answered) {
  const std::lock_guard lock(mutex_);
  answered_.push_back(std::move(answered));
}
void Told::add_fault(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  faults_.push_back(fault);
}
std::vector<Seen> Told::seen() const {
  const std::lock_guard lock(mutex_);
  return seen_;
}
std::size_t Told::answer_count() const {
  const std::lock_guard lock(mutex_);
  return seen_.size() + answered_.size();
}
std::vector<Answered> Told::answered() const {
  const std::lock_guard lock(mutex_);
  return answered_;
}
std::vector<std::string> Told::faults() const {
  const std::lock_guard lock(mutex_);
  return faults_;
}

void load_session(std::uint16_t port, const std::string& session, std::uint64_t name, Told& told) {
  try {
    Load(port, session, name, told).run();
  } catch (const Gone&) {
    // as it must, once the server is killed
  } catch (const std::exception& fault) {
    told.add_fault(session + ": " + fault.what());
  }
}

std::string create_session(std::uint16_t port, const std::string& name, const std::string& scene) {
  return Caller(port).result("session.create", {{"name", name}, {"scene", scene}}).at("session");
}

std::vector<std::pair<std::string, std::string>> list_sessions(std::uint16_t port) {
  Caller caller(port);
  std::vector<std::pair<std::string, std::string>> running;
  const auto are_all_running = [&] {
    running.clear();
    const Json sessions = caller.result("session.list").at("sessions");
    for (const Json& session : sessions) {
      if (session.at("state") == "running") {
        running.emplace_back(session.at("session"), session.at("name"));
      }
    }
    return running.size() == sessions.size();
  };
  wait_until(are_all_running);
  return running;
}

}  // namespace vat::test
