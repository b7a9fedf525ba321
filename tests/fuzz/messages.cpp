#include <spdlog/spdlog.h>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <memory>
#include <mutex>
#include <string>

#include "protocol/frame/frame_codec.h"
#include "protocol/scene/scene_json.h"
#include "server/access/token.h"
#include "server/rpc/session_server.h"
#include "tests/fuzz/target.h"

namespace {

using namespace vat;

constexpr std::string_view kAdminToken = "admin";
/// The id of a client's last message. The server executes the earlier messages before it replies.
constexpr std::string_view kLastId = "the last";

/// The newest token that a client received. Random messages can then use a valid token.
class NewestToken {
 public:
  void keep(const Json& result) {
    for (const char* key : {"token", "resume"}) {
      const std::lock_guard lock(mutex_);
      if (result.is_object() && result.contains(key)) token_ = result[key].get<std::string>();
    }
  }
  std::string get() const {
    const std::lock_guard lock(mutex_);
    return token_;
  }

 private:
  mutable std::mutex mutex_;
  std::string token_;
};

/// A client that checks the received messages.
class CheckingConnection final : public Connection {
 public:
  CheckingConnection(ConnectionId id, NewestToken& token) : id_(id), token_(token) {}

  ConnectionId id() const override { return id_; }
  const std::string& address() const override { return address_; }
  void send_text(std::string message, std::shared_ptr<const std::string> tail) override {
    if (tail != nullptr) message += *tail;
    const Json json = Json::parse(message, nullptr, false);
    VAT_CHECK(json.is_object() && json.value("jsonrpc", "") == "2.0");
    const bool is_reply = json.contains("id");
    VAT_CHECK(is_reply ? json.contains("result") != json.contains("error")
                       : json.contains("method") && json.contains("params"));
    VAT_CHECK(!json.contains("error") || json["error"]["code"] != kInternalError);
    token_.keep(json.value("result", Json()));
    if (is_reply && json["id"] == kLastId) finish();
  }
  void send_binary(std::shared_ptr<const std::string> bytes) override {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
    const std::lock_guard lock(mutex_);
    VAT_CHECK(decoder_.decode({data, bytes->size()}).ok());
  }
  std::size_t queued_bytes() const override { return 0; }
  void close(std::uint16_t, std::string_view) override { finish(); }

  /// Waits for the reply to kLastId for a limited time.
  void wait_for_last() {
    std::unique_lock lock(mutex_);
    finished_.wait_for(lock, kPatience, [&] { return is_finished_; });
  }

 private:
  static constexpr int kInternalError = -32603;
  static constexpr std::chrono::milliseconds kPatience{200};

  void finish() {
    const std::lock_guard lock(mutex_);
    is_finished_ = true;
    finished_.notify_all();
  }

  const ConnectionId id_;
  NewestToken& token_;
  std::mutex mutex_;
  std::condition_variable finished_;
  bool is_finished_ = false;
  FrameDecoder decoder_;
  const std::string address_ = "127.0.0.1";
};

/// A small scene, so that messages dominate the time of an input.
Scene first_scene() {
  const Result<Scene> scene = read_scene_text(
      R"({"format": "vat.scene/1", "numerics": {"step": 0.01, "tick": 0.01},
          "materials": [{"name": "m"}],
          "bodies": [{"name": "one", "kind": "rigid", "material": "m", "mass": 1, "radius": 0.1,
                      "shape": {"type": "particles", "positions": [[0, 0, 0], [1, 0, 0]]}},
                     {"name": "two", "kind": "deformable", "material": "m", "mass": 1,
                      "radius": 0.1, "shape": {"type": "particles",
                                               "positions": [[3, 0, 0], [4, 0, 0]]},
                      "springs": [{"particles": [0, 1], "stiffness": 10}]}]})",
      [](const std::string&) {
        return Error{"no_such_file", "", "there are no files"};
      });
  return scene.value();
}

ServerSettings small_settings(bool needs_token) {
  ServerSettings settings;
  settings.threads = 1;
  settings.limits.max_particles = 1000;
  settings.limits.max_particle_steps_per_tick = 2000;
  settings.limits.max_sessions = 3;
  settings.access.mode = needs_token ? AccessMode::token : AccessMode::open;
  settings.access.admin = hash_of_token(kAdminToken);
  settings.access.refusal_delay = std::chrono::milliseconds(0);
  settings.limits.burst_seconds = 1e9;  // disables rate limits
  return settings;
}

/// Three clients of a server. Each may disconnect and reconnect.
class Clients {
 public:
  Clients(SessionServer& server, NewestToken& token) : server_(server), token_(token) {
    for (auto& client : clients_) open(client);
  }
  /// Lets the server execute all sent messages.
  ~Clients() {
    const Json last{{"jsonrpc", "2.0"}, {"id", kLastId}, {"method", "session.hash"}};
    for (const auto& client : clients_) server_.text_received(client->id(), last.dump());
    for (const auto& client : clients_) client->wait_for_last();
    for (const auto& client : clients_) server_.closed(client->id());
  }
  Clients(const Clients&) = delete;
  Clients& operator=(const Clients&) = delete;

  /// Plays a line. '2' and '3' at its start select the client. "~" reconnects it, "!" sends the
  /// rest as a binary message. "@token" is the newest token.
  void play(std::string_view line) {
    auto& client = clients_[take(line, '2') ? 1 : take(line, '3') ? 2 : 0];
    if (take(line, '~')) {
      server_.closed(client->id());
      open(client);
    } else if (take(line, '!')) {
      server_.binary_received(client->id(), line);
    } else {
      server_.text_received(client->id(), with_token(std::string(line)));
    }
  }

 private:
  static bool take(std::string_view& line, char first) {
    if (!line.starts_with(first)) return false;
    line.remove_prefix(1);
    return true;
  }
  void open(std::shared_ptr<CheckingConnection>& client) {
    client = std::make_shared<CheckingConnection>(++last_, token_);
    server_.opened(client);
  }
  std::string with_token(std::string text) const {
    constexpr std::string_view kName = "@token";
    const std::size_t at = text.find(kName);
    if (at != std::string::npos) text.replace(at, kName.size(), token_.get());
    return text;
  }

  SessionServer& server_;
  NewestToken& token_;
  ConnectionId last_ = 0;
  std::array<std::shared_ptr<CheckingConnection>, 3> clients_;
};

}  // namespace

/// The input contains messages of three clients to a separate server, one per line. If the first
/// line is "token", clients have to enter. Every reply is well-formed and reports no server fault,
/// every frame can be decoded, and the server can be stopped.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Catalogue catalogue = Catalogue::open(VAT_FUZZ_SCENES).value();
  static const Scene scene = first_scene();
  spdlog::set_level(spdlog::level::off);
  std::string_view text = fuzz::to_text(data, size);
  NewestToken token;
  SystemClock clock;
  SessionServer server(catalogue, small_settings(text.starts_with("token\n")), clock);
  VAT_CHECK(server.create_session("first", scene).ok());
  {
    Clients clients(server, token);
    while (!text.empty()) {
      const std::string_view line = text.substr(0, text.find('\n'));
      text.remove_prefix(std::min(line.size() + 1, text.size()));
      clients.play(line);
    }
  }
  server.stop();
  return 0;
}
