#include <spdlog/spdlog.h>

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <memory>

#include "protocol/frame_codec.h"
#include "protocol/scene_json.h"
#include "server/session/session_server.h"
#include "tests/fuzz/target.h"

namespace {

using namespace vat;

/// A client that checks what it is sent.
class CheckingConnection final : public Connection {
 public:
  ConnectionId id() const override { return 1; }
  void send_text(std::string message) override {
    const Json json = Json::parse(message, nullptr, false);
    VAT_CHECK(json.is_object() && json.value("jsonrpc", "") == "2.0");
    const bool is_reply = json.contains("id");
    VAT_CHECK(is_reply ? json.contains("result") != json.contains("error")
                       : json.contains("method") && json.contains("params"));
    VAT_CHECK(!json.contains("error") || json["error"]["code"] != kInternalError);
  }
  void send_binary(std::shared_ptr<const std::string> bytes) override {
    const auto* data = reinterpret_cast<const std::uint8_t*>(bytes->data());
    VAT_CHECK(decode_key_frame({data, bytes->size()}).ok());
  }
  std::size_t queued_bytes() const override { return 0; }
  void close(std::uint16_t, std::string_view) override {}

 private:
  static constexpr int kInternalError = -32603;
};

/// A small scene, so that an input takes no longer than its messages.
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

Catalogue empty_catalogue() {
  const std::filesystem::path folder =
      std::filesystem::temp_directory_path() / "vat-fuzz-empty-catalogue";
  std::filesystem::create_directories(folder);
  return Catalogue::open(folder.string()).value();
}

ServerSettings small_settings() {
  ServerSettings settings;
  settings.threads = 1;
  settings.limits.max_particles = 1000;
  settings.limits.max_particle_steps_per_tick = 2000;
  settings.limits.max_sessions = 3;
  return settings;
}

}  // namespace

/// The messages of one client to a server of its own, one a line. Every answer is well formed, none
/// is a fault of the server, and the server can be stopped.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Catalogue catalogue = empty_catalogue();
  static const Scene scene = first_scene();
  spdlog::set_level(spdlog::level::off);
  SessionServer server(catalogue, small_settings());
  VAT_CHECK(server.create_session("first", scene).ok());
  server.opened(std::make_shared<CheckingConnection>());
  for (std::string_view text = fuzz::to_text(data, size); !text.empty();) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    server.text_received(1, line);
  }
  server.closed(1);
  server.stop();
  return 0;
}
