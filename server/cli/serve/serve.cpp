#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/signal_set.hpp>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <iostream>
#include <iterator>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/device/device_use.h"
#include "protocol/scene/scene_json.h"
#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/scene_argument.h"
#include "server/cli/serve/certificate_watch.h"
#include "server/cli/serve/open_files.h"
#include "server/cli/serve/serve_access.h"
#include "server/http/downloads.h"
#include "server/http/http_site.h"
#include "server/http/static_files.h"
#include "server/operations/heap.h"
#include "server/operations/log_format.h"
#include "server/rpc/session_server.h"
#include "server/settings/serve_settings.h"
#include "server/settings/setting_sources.h"
#include "server/support/clock.h"
#include "server/support/log.h"
#include "server/transport/transport.h"

namespace vat {

namespace {

namespace asio = boost::asio;

/// Open files beside the connections: refused ones, HTTP requests, the log, the threads' own.
constexpr std::size_t kOtherFiles = 512;

/// Adds the file name and options for ./vat check and the tests.
constexpr std::string_view kOtherVariables[] = {"VAT_ADMIN_TOKEN", "VAT_CLUSTER_KEY", "VAT_CONFIG",
                                                "VAT_FUZZ_SECONDS", "VAT_KILLS"};

constexpr const char* kServeFooter =
    R"(Every setting can also be an environment variable (VAT_MAX_CONNECTIONS for --max-connections)
or a member of the configuration file ("max_connections"). Variables override the file, and options
override both.

When the server is ready, it prints a line with its URL. If it has generated an admin token, it
prints the admin link before. All other output goes to standard error.
SIGINT ends the server cleanly. SIGTERM also does, after clients had --drain-seconds to leave. A
second signal ends the server immediately. With TLS, SIGHUP reads the certificate again.

Exit codes: 0 stopped by a signal, 1 invalid scene or configuration file, unreadable folder, data
that cannot be used or port in use, 2 wrong usage, or a variable with a bad value.)";

/// Waits for SIGINT or SIGTERM, also for one that came since the construction.
class StopSignal {
 public:
  StopSignal(asio::io_context& io, std::chrono::milliseconds drain_time)
      : usual_drain_time_(drain_time),
        drain_time_(drain_time),
        io_(io),
        signals_(io, SIGINT, SIGTERM) {
    signals_.async_wait([this](boost::system::error_code cancelled, int signal) {
      if (cancelled) return;
      // By SIGTERM operators end a server that others use.
      if (signal == SIGINT) drain_time_ = std::chrono::milliseconds(0);
      log_info("stopping: {}", signal == SIGTERM ? "SIGTERM" : "SIGINT");
      signals_.clear();  // the next one ends the process
      io_.stop();
    });
  }
  /// Runs the context until it comes, or request(); how long clients may stay then.
  std::chrono::milliseconds wait() {
    io_.run();
    return drain_time_;
  }
  /// Acts as a received signal, from any thread. Returns the time for clients.
  std::chrono::milliseconds request(std::optional<std::chrono::milliseconds> drain_time) {
    const auto given = drain_time.value_or(usual_drain_time_);
    asio::post(io_, [this, given] {
      log_info("stopping: server.drain");
      drain_time_ = given;
      signals_.clear();
      io_.stop();
    });
    return given;
  }

 private:
  const std::chrono::milliseconds usual_drain_time_;
  std::chrono::milliseconds drain_time_;
  asio::io_context& io_;
  asio::signal_set signals_;
};

/// An address that a browser on this machine can open.
std::string viewer_url(const ServeSettings& options, std::uint16_t port) {
  asio::ip::address address = asio::ip::make_address(options.host);
  if (address == asio::ip::address_v4::any()) address = asio::ip::address_v4::loopback();
  if (address == asio::ip::address_v6::any()) address = asio::ip::address_v6::loopback();
  const std::string text = address.to_string();
  const std::string scheme = options.tls_certificate.empty() ? "http://" : "https://";
  return scheme + (address.is_v6() ? "[" + text + "]" : text) + ":" + std::to_string(port) + "/";
}

void raise_file_limit(std::size_t connections) {
  const std::size_t allowed = raise_open_files(connections + kOtherFiles);
  if (allowed >= connections + kOtherFiles) return;
  log_warning(
      "the system allows {} open files (ulimit -n), too few for {} connections: the server will "
      "reject connections beyond about {}",
      allowed, connections, allowed - std::min(allowed, kOtherFiles));
}

TransportSettings transport_settings(const ServeSettings& options, SessionServer& sessions) {
  TransportSettings settings;
  settings.endpoints = options.endpoints;
  settings.host = options.host;
  settings.port = options.port;
  settings.tls_certificate = options.tls_certificate;
  settings.tls_key = options.tls_key;
  settings.allowed_origins = options.allow_origin;
  settings.public_names = options.public_name;
  settings.trusted_proxies = options.trusted_proxy;
  settings.max_connections = options.limits.max_connections;
  settings.max_connections_per_address = options.limits.max_connections_per_address;
  settings.max_message_bytes = options.limits.max_scene_message_bytes;
  settings.handshake_timeout = options.limits.handshake_time;
  settings.ping_interval = options.limits.ping_interval;
  settings.report = [](std::string_view fault) { log_error("internal error: {}", fault); };
  settings.count_refusal = [&](std::string_view limit) { sessions.count_refusal(limit); };
  settings.count_close = [&](std::uint16_t code) { sessions.count_close(code); };
  return settings;
}

std::string version_json(const ServerSettings& settings) {
  return Json{{"name", "vat"},
              {"version", settings.version},
              {"protocol", "vat.v1"},
              {"instruction_set", to_string(settings.instructions)}}
      .dump();
}

ServerPhase phase_of(const SharedPhase& phase, const SessionServer& sessions) {
  const ServerPhase now = phase;
  if (now != ServerPhase::ready) return now;
  if (sessions.is_replaced()) return ServerPhase::replaced;
  return sessions.is_ready() ? now : ServerPhase::recovering;
}

/// Serves until a signal comes.
int serve(const ServeSettings& options, const ServeAccess& access, const Catalogue& catalogue,
          const Scene& scene, StaticFiles viewer) {
  prepare_heap();
  asio::io_context main_thread;
  StopSignal stop_signal(main_thread, options.drain_time);
  MemoryReturn memory_return(main_thread);
  SharedPhase phase = ServerPhase::starting;
  ServerSettings settings;
  settings.version = VAT_VERSION;
  settings.threads = options.threads;
  settings.limits = options.limits;
  settings.access = access.settings;
  if (options.instructions != "best") {
    settings.instructions = parse_instruction_set(options.instructions).value();
  }
  log_info("instruction set: {}", to_string(settings.instructions));
  if (options.device != "scene") {
    settings.device = parse_device(options.device).value();
    const Status found = check_device(*settings.device);
    if (!found) return fail("vat serve", found.errors());
  }
  if (options.data == "none") {
    log_info("sessions exist in memory only (--data FOLDER stores them)");
  } else {
    settings.data_folder = options.data;
  }
  settings.storage = options.storage;
  if (options.durability == "process") settings.storage.durability = Durability::process;
  settings.cluster = options.cluster;
  settings.cluster.key = access.cluster_key;
  settings.end = [&](auto drain_time) { return stop_signal.request(drain_time); };
  SystemClock clock;
  SessionServer sessions(catalogue, settings, clock);
  if (sessions.recover() == 0) {
    const Result<SessionId> session = sessions.create_session(scene.name, scene);
    // Another node of the cluster may have created it at the same time.
    if (!session && !options.cluster.is_used()) return fail(options.scene, session.errors());
    if (!session) log_warning("no first session: {}", session.errors().front().message);
  }

  const auto transport = make_websocket_transport(
      transport_settings(options, sessions), sessions,
      sessions.serve_downloads(make_http_site(
          std::move(viewer),
          {[&] { return sessions.metrics(); }, [&] { return sessions.slow_ticks(); },
           [&](std::string_view authorization) {
             return may_read_metrics(settings.access, authorization);
           },
           [&] { return phase_of(phase, sessions); }, [&] { return sessions.health(); },
           version_json(settings), options.allow_origin})));
  raise_file_limit(settings.limits.max_connections);
  std::optional<CertificateWatch> certificate_watch;
  if (!options.tls_certificate.empty()) {
    certificate_watch.emplace(main_thread, std::vector{options.tls_certificate, options.tls_key},
                              [&] { transport->read_certificate(); });
  }
  const std::uint16_t port = transport->start();
  const std::string url = viewer_url(options, port);
  tell_access(options, access, url);
  phase = ServerPhase::ready;
  // The last line, because a reader may close its end of the pipe after it.
  std::cout << "vat is at " << url << " (Ctrl-C stops it)" << std::endl;
  const std::chrono::milliseconds drain_time = stop_signal.wait();
  phase = ServerPhase::draining;
  sessions.drain(drain_time);
  sessions.stop();
  transport->stop();
  return kExitOk;
}

int load_and_serve(const ServeSettings& options) {
  const Result<Catalogue> catalogue = Catalogue::open(options.scenes_folder);
  if (!catalogue) return fail(options.scenes_folder, catalogue.errors());
  const Result<Scene> scene = load_scene(options.scene, options.scenes_folder);
  if (!scene) return fail(options.scene, scene.errors());
  Result<StaticFiles> viewer = StaticFiles::read(options.web_folder);
  if (!viewer) return fail(options.web_folder, viewer.errors());
  if (viewer.value().empty()) log_warning("there is no viewer in {}", options.web_folder);
  const Result<ServeAccess> access = serve_access(options);
  if (!access) return fail("access", access.errors());
  return serve(options, access.value(), catalogue.value(), scene.value(),
               std::move(viewer).value());
}

/// The settings, their table, and their values on the command line.
struct CommandLine {
  ServeSettings settings;
  std::vector<Setting> table;
  SettingTexts options;
  std::string config;
  bool print_config = false;
  bool print_variables = false;
};

void add_setting(CLI::App& command, const Setting& setting, SettingTexts& texts) {
  const auto check = [&setting](const std::string& text) {
    const std::string fault = setting.find_fault(to_json(setting, text));
    return fault.empty() ? fault : fault + ", not '" + text + "'";
  };
  const auto keep = [&setting, &texts](const std::string& text) { texts[setting.name] = text; };
  CLI::Option* const option =
      command.add_option_function<std::string>(option_of(setting), keep, setting.help);
  if (setting.is_list) option->join(',');
  option->check(CLI::Validator(check, ""))
      ->type_name(setting.range.find(' ') == std::string::npos ? setting.range
                                                               : '[' + setting.range + ']')
      ->default_str(to_text(setting.value()))
      ->group(setting.group);
}

void add_serve_options(CLI::App& command, CommandLine& line) {
  line.settings.scenes_folder = installed_scenes_folder();
  line.settings.web_folder = installed_web_folder();
  line.table = serve_settings(line.settings);
  command.add_option("--config", line.config, "Configuration file: a JSON object with settings")
      ->type_name("FILE")
      ->envname("VAT_CONFIG");
  command.add_flag("--print-config", line.print_config,
                   "Print all settings with their values and sources, and exit");
  command.add_flag("--print-variables", line.print_variables,
                   "Print all settings as environment variables with comments, and exit");
  for (const Setting& setting : line.table) add_setting(command, setting, line.options);
}

/// The variables of the environment, but those that are read elsewhere.
std::vector<std::string> environment() {
  std::vector<std::string> entries;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view name = std::string_view(*entry).substr(0, std::strcspn(*entry, "="));
    if (std::ranges::find(kOtherVariables, name) == std::end(kOtherVariables)) {
      entries.emplace_back(*entry);
    }
  }
  return entries;
}

int fail_in_file(const std::string& file, Errors errors) {
  for (Error& error : errors) error.path = file + (error.path.empty() ? "" : ": " + error.path);
  return fail(file, errors);
}

/// Returns the reason why the settings of the cluster do not fit together, or null.
const char* find_cluster_fault(const ServeSettings& settings) {
  const ClusterSettings& cluster = settings.cluster;
  if (cluster.tls_certificate.empty() != cluster.tls_key.empty()) {
    return "cluster_tls_certificate and cluster_tls_key must be set together";
  }
  if (!cluster.is_used()) {
    return cluster.node.empty() ? nullptr : "node requires cluster, the URLs of the NATS servers";
  }
  if (cluster.node.empty()) return "cluster requires node, the name of this node";
  if (cluster.public_url.empty()) return "cluster requires public_url, the URL of this node";
  if (settings.data == "none") return "cluster requires data, a folder for the working copies";
  return nullptr;
}

int run(CommandLine& line) {
  if (line.print_variables) {
    std::cout << environment_file(line.table);
    return kExitOk;
  }
  const std::vector<std::string> variables = environment();
  SettingSources sources;
  if (!line.config.empty()) {
    const Status read = apply_file(line.table, line.config, sources);
    if (!read) return fail_in_file(line.config, read.errors());
  }
  const Status read = apply_environment(line.table, variables, sources);
  if (!read) {
    print_errors(std::cerr, "the environment", read.errors());
    return kExitUsage;
  }
  apply_options(line.table, line.options, sources);
  if (line.settings.tls_certificate.empty() != line.settings.tls_key.empty()) {
    std::cerr << "tls_certificate and tls_key must be set together\n";
    return kExitUsage;
  }
  if (const char* const fault = find_cluster_fault(line.settings)) {
    std::cerr << fault << '\n';
    return kExitUsage;
  }
  const std::vector<std::string> unknown = unknown_variables(line.table, variables);
  if (line.print_config) {
    for (const std::string& one : unknown)
      std::cerr << "an environment variable is not a setting: " << one << '\n';
    std::cout << describe(line.table, sources).dump(2) << '\n';
    return kExitOk;
  }
  start_log(line.settings.log_level, line.settings.log_format == "json");
  for (const std::string& one : unknown)
    log_warning("an environment variable is not a setting: {}", one);
  return load_and_serve(line.settings);
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  CLI::App* command = app.add_subcommand("serve", "Serve the viewer and run sessions");
  const auto line = std::make_shared<CommandLine>();
  add_serve_options(*command, *line);
  command->footer(kServeFooter);
  command->callback([line, &exit_code] { exit_code = run(*line); });
}

}  // namespace vat
