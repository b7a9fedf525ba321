#include "tests/recovery/load.h"

#include "tests/support/wait.h"

namespace vat::test {
namespace {

/// The load of one client.
class Load {
 public:
  Load(WaitingClient client, std::string session, std::uint64_t name, Told& told)
      : client_(std::move(client)), session_(std::move(session)), name_(name), told_(told) {}

  void run() {
    const Json joined = client_.result("session.join", {{"session", session_}});
    body_ = joined.at("description").at("bodies").at(0).at("body");
    for (std::uint64_t round = 1;; ++round) {
      change(round);
      look();
    }
  }

 private:
  /// Returns a unique number.
  double mark(std::uint64_t round) const {
    return static_cast<double>(name_) + static_cast<double>(round) / 1048576;
  }

  void command(const std::string& method, const Json& params) {
    if (client_.call(method, params).contains("result"))
      told_.add(Answered{session_, method, params.dump()});
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
    const Json reply = client_.call("grab.start", start);
    if (!reply.contains("result")) return;
    const Json grab = reply.at("result").at("grab");
    told_.add(Answered{session_, "grab.start", start.dump()});
    command("grab.move", {{"grab", grab}, {"target", {0.4, number * 1e-3, 0.5}}});
    command("grab.end", {{"grab", grab}});
  }

  void add_and_remove(double number) {
    const Json params{{"body",
                       {{"name", "ball " + std::to_string(number)},
                        {"kind", "rigid"},
                        {"material", "wood"},
                        {"spacing", 0.1},
                        {"shape", {{"type", "sphere"}, {"radius", 0.12}}},
                        {"position", {0.5, 0.5, 0.8}}}}};
    const Json added = client_.call("world.add_body", params);
    if (!added.contains("result")) return;
    told_.add(Answered{session_, "world.add_body", params.dump()});
    command("world.remove_body", {{"body", added.at("result").at("body")}});
  }

  void look() {
    const Json state = client_.result("session.hash");
    told_.add(Seen{session_, state.at("position"), state.at("hash")});
  }

  WaitingClient client_;
  const std::string session_;
  const std::uint64_t name_;
  Told& told_;
  int body_ = 0;
};

}  // namespace

void Told::add(Seen one) {
  const std::lock_guard lock(mutex_);
  seen.push_back(std::move(one));
}
void Told::add(Answered one) {
  const std::lock_guard lock(mutex_);
  answered.push_back(std::move(one));
}
void Told::add_fault(const std::string& fault) {
  const std::lock_guard lock(mutex_);
  faults.push_back(fault);
}
std::size_t Told::answer_count() const {
  const std::lock_guard lock(mutex_);
  return seen.size() + answered.size();
}

WaitingClient connect(std::uint16_t port) {
  WaitingClient client(port);
  if (!client.is_connected()) throw Gone("no connection");
  return client;
}

void load_session(WaitingClient client, const std::string& session, std::uint64_t name,
                  Told& told) {
  try {
    Load(std::move(client), session, name, told).run();
  } catch (const Gone&) {
    // expected when the server is killed
  } catch (const std::exception& fault) {
    told.add_fault(session + ": " + fault.what());
  }
}

std::string create_session(std::uint16_t port, const std::string& name, const std::string& scene) {
  return connect(port).result("session.create", {{"name", name}, {"scene", scene}}).at("session");
}

std::vector<std::pair<std::string, std::string>> list_sessions(std::uint16_t port) {
  WaitingClient caller = connect(port);
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
