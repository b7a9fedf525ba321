#include "server/cli/serve.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <iostream>
#include <memory>
#include <string>
#include <string_view>
#include <utility>

#include "protocol/scene_json.h"
#include "server/cli/command.h"
#include "server/cli/open_files.h"
#include "server/cli/option_checks.h"
#include "server/cli/scene_argument.h"
#include "server/http/http_site.h"
#include "server/http/static_files.h"
#include "server/net/transport.h"
#include "server/session/session_server.h"

namespace vat {

namespace {

namespace asio = boost::asio;

constexpr std::size_t kMaxThreads = 256;
constexpr std::size_t kMaxEndpoints = 64;
constexpr std::size_t kMostConnections = 100'000;
constexpr double kMostResumeSeconds = 3600;
/// Open files beside the connections: refused ones, HTTP requests, the log, the threads' own.
constexpr std::size_t kOtherFiles = 512;

constexpr const char* kFooter = R"(Prints one line with its URL when it is ready; all else goes to
standard error. SIGINT and SIGTERM end it cleanly, a second one at once.

Exit codes: 0 stopped by a signal, 1 invalid scene, unreadable folder or port in use, 2 wrong usage.)";

struct Options {
  std::string host = "127.0.0.1";
  std::uint16_t port = 8080;
  std::string scene = "sliding-vat-liquid";
  std::string scenes_folder = VAT_DEFAULT_SCENES_DIR;
  std::string web_folder = VAT_DEFAULT_WEB_DIR;
  std::size_t threads = 0;
  std::size_t endpoints = 1;
  ServerLimits limits;
  double resume_seconds = 30;
  InstructionSet instructions = best_instruction_set();
  std::string log_level = "info";
};

void start_log(const std::string& level) {
  spdlog::set_default_logger(spdlog::stderr_color_mt("vat"));
  spdlog::set_level(spdlog::level::from_str(level));
}

/// Waits for SIGINT or SIGTERM, also for one that came since the construction.
class StopSignal {
 public:
  StopSignal() : signals_(io_, SIGINT, SIGTERM) {
    signals_.async_wait([this](boost::system::error_code, int signal) {
      spdlog::info("stopping: {}", signal == SIGINT ? "SIGINT" : "SIGTERM");
      signals_.clear();  // the next one ends the process
    });
  }
  void wait() { io_.run(); }

 private:
  asio::io_context io_;
  asio::signal_set signals_;
};

/// An address that a browser on this machine can open.
std::string viewer_url(const std::string& host, std::uint16_t port) {
  asio::ip::address address = asio::ip::make_address(host);
  if (address == asio::ip::address_v4::any()) address = asio::ip::address_v4::loopback();
  if (address == asio::ip::address_v6::any()) address = asio::ip::address_v6::loopback();
  const std::string text = address.to_string();
  return "http://" + (address.is_v6() ? "[" + text + "]" : text) + ":" + std::to_string(port) + "/";
}

void warn_of_open_host(const std::string& host) {
  if (asio::ip::make_address(host).is_loopback()) return;
  spdlog::warn("listening on {}: whoever can reach this address can use the server", host);
}

void raise_file_limit(std::size_t connections) {
  const std::size_t allowed = raise_open_files(connections + kOtherFiles);
  if (allowed >= connections + kOtherFiles) return;
  spdlog::warn(
      "the system allows {} open files (ulimit -n): too few for {} connections, and those beyond "
      "about {} will be refused",
      allowed, connections, allowed - std::min(allowed, kOtherFiles));
}

TransportSettings transport_settings(const Options& options, const ServerLimits& limits) {
  TransportSettings settings;
  settings.endpoints = options.endpoints;
  settings.host = options.host;
  settings.port = options.port;
  settings.max_connections = limits.max_connections;
  settings.max_message_bytes = limits.max_scene_message_bytes;
  settings.report = [](std::string_view fault) { spdlog::error("internal error: {}", fault); };
  return settings;
}

/// Serves until a signal comes.
int serve(const Options& options, const Catalogue& catalogue, const Scene& scene,
          StaticFiles viewer) {
  StopSignal stop_signal;
  ServerSettings settings;
  settings.version = VAT_VERSION;
  settings.threads = options.threads;
  settings.limits = options.limits;
  settings.limits.resume_time =
      std::chrono::milliseconds(std::llround(1000 * options.resume_seconds));
  settings.instructions = options.instructions;
  spdlog::info("instruction set: {}", to_string(settings.instructions));
  SessionServer sessions(catalogue, settings);
  const Result<SessionId> session = sessions.create_session(scene.name, scene);
  if (!session) return fail(options.scene, session.errors());

  const auto transport = make_websocket_transport(
      transport_settings(options, settings.limits), sessions,
      make_http_site(std::move(viewer), [&] { return sessions.metrics(); }));
  raise_file_limit(settings.limits.max_connections);
  const std::uint16_t port = transport->start();
  warn_of_open_host(options.host);
  std::cout << "vat is at " << viewer_url(options.host, port) << " (Ctrl-C stops it)" << std::endl;
  stop_signal.wait();
  sessions.stop();
  transport->stop();
  return kExitOk;
}

int load_and_serve(const Options& options) {
  start_log(options.log_level);
  const Result<Catalogue> catalogue = Catalogue::open(options.scenes_folder);
  if (!catalogue) return fail(options.scenes_folder, catalogue.errors());
  const Result<Scene> scene = load_scene(options.scene, options.scenes_folder);
  if (!scene) return fail(options.scene, scene.errors());
  Result<StaticFiles> viewer = StaticFiles::read(options.web_folder);
  if (!viewer) return fail(options.web_folder, viewer.errors());
  if (viewer.value().empty()) spdlog::warn("there is no viewer in {}", options.web_folder);
  return serve(options, catalogue.value(), scene.value(), std::move(viewer).value());
}

std::string check_host(const std::string& host) {
  boost::system::error_code error;
  asio::ip::make_address(host, error);
  if (!error) return {};
  return "'" + host + "' must be a numeric address, such as 127.0.0.1, 0.0.0.0 or ::1";
}

void add_options(CLI::App& command, Options& options) {
  command.add_option("--host", options.host, "Address to listen on; 0.0.0.0: all of the machine")
      ->check(CLI::Validator(check_host, "ADDRESS"))
      ->capture_default_str();
  command.add_option("--port", options.port, "Port to listen on; 0: any free one")
      ->check(CLI::Range(0, 65535))
      ->capture_default_str();
  command.add_option("--scene", options.scene, "The first session's. " + std::string(kSceneHelp))
      ->capture_default_str();
  command.add_option("--scenes", options.scenes_folder, "Folder of the catalogue");
  command.add_option("--web", options.web_folder, "Folder of the built viewer");
  command
      .add_option("--threads", options.threads,
                  "Threads that step sessions, and share the steps of the few; 0: one per core")
      ->check(CLI::Range(std::size_t{0}, kMaxThreads))
      ->capture_default_str();
  command
      .add_option(
          "--endpoints", options.endpoints,
          "Threads that share the connections of the port; one serves about a thousand viewers")
      ->check(CLI::Range(std::size_t{1}, kMaxEndpoints))
      ->capture_default_str();
  command
      .add_option("--max-connections", options.limits.max_connections,
                  "WebSockets at once; the next is closed")
      ->check(CLI::Range(std::size_t{1}, kMostConnections))
      ->capture_default_str();
  command
      .add_option("--max-clients", options.limits.max_clients_per_session, "Clients of one session")
      ->check(CLI::Range(std::size_t{1}, kMostConnections))
      ->capture_default_str();
  command
      .add_option("--resume-seconds", options.resume_seconds,
                  "Time in which a participant whose connection has ended can be resumed")
      ->check(CLI::Range(0.0, kMostResumeSeconds))
      ->capture_default_str();
  add_isa_option(command, options.instructions);
  command.add_option("--log-level", options.log_level, "What to log")
      ->check(CLI::IsMember({"debug", "info", "warn", "error", "off"}))
      ->capture_default_str();
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("serve", "Serve the viewer and run sessions");
  const auto options = std::make_shared<Options>();
  add_options(*command, *options);
  command->footer(kFooter);
  command->callback([options, &exit_code] { exit_code = load_and_serve(*options); });
}

}  // namespace vat
