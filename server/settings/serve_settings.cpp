#include "server/settings/serve_settings.h"

#include <boost/asio/ip/address.hpp>
#include <utility>

#include "core/limits.h"
#include "core/scene/device_choice.h"
#include "core/support/instruction_set.h"
#include "server/history/recording.h"
#include "server/transport/client_address.h"
#include "server/transport/host_names.h"

namespace vat {
namespace {

constexpr std::size_t kMaxThreads = 256;
constexpr std::size_t kMaxEndpoints = 64;
constexpr std::size_t kMaxConnectionSetting = 100'000;
constexpr std::size_t kMaxSessions = 10'000;
constexpr std::size_t kMinDepth = 10;  // of a request with a scene: 9
constexpr std::size_t kMaxBytes = 1024 * 1024 * 1024;
constexpr std::size_t kMaxInAll = 1'000'000'000;
constexpr std::size_t kMostMemory = std::size_t{1} << 40;
constexpr double kMaxPerSecond = 1e6;
constexpr double kMaxBytesPerSecond = 1e9;
constexpr double kMaxReadSeconds = 64;  // more than the read thread can use
constexpr double kMaxAway = 1e8;
constexpr std::uint64_t kMaxSeconds = 3600;

std::string check_host(const std::string& host) {
  boost::system::error_code error;
  boost::asio::ip::make_address(host, error);
  return error ? "must be a numeric address, such as 127.0.0.1, 0.0.0.0 or ::1" : std::string();
}

std::string check_origin(const std::string& origin) {
  constexpr std::string_view kInHosts =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_:[]";
  const bool has_scheme = origin.starts_with("https://") || origin.starts_with("http://");
  if (!has_scheme || origin.ends_with("//") ||
      origin.find_first_not_of(kInHosts, origin.find("//") + 2) != std::string::npos) {
    return "must be origins separated by commas, such as https://example.org:8443";
  }
  return {};
}

std::string check_public_name(const std::string& name) {
  if (is_host_name(name)) return {};
  return "must be ASCII host names separated by commas, such as example.org or example.org:8443";
}

std::string check_proxy(const std::string& network) {
  if (is_network(network)) return {};
  return "must be numeric addresses or networks separated by commas, such as 10.0.0.1 or fd00::/8";
}

std::string check_instructions(const std::string& name) {
  if (name == "best") return {};
  const Result<InstructionSet> set = parse_instruction_set(name);
  const Status usable = set ? check_available(set.value()) : Status(set.errors());
  return usable ? std::string() : usable.errors().front().message;
}

std::string check_device(const std::string& device) {
  if (device == "scene" || parse_device(device)) return {};
  return std::string("must be scene, ") + kDeviceForm;
}

bool has_only(std::string_view text, std::string_view characters) {
  return text.find_first_not_of(characters) == std::string_view::npos;
}

constexpr std::string_view kUrlCharacters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_:[]@/";

std::string check_nats_url(const std::string& url) {
  const bool has_scheme = url.starts_with("nats://") || url.starts_with("tls://");
  if (has_scheme && !url.ends_with("/") && has_only(url, kUrlCharacters)) return {};
  return "must be URLs separated by commas, such as nats://127.0.0.1:4222 or "
         "tls://nats.example:4222";
}

std::string check_node(const std::string& name) {
  constexpr std::size_t kMaxNodeName = 64;
  constexpr std::string_view kInNames =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_";
  if (name.size() <= kMaxNodeName && has_only(name, kInNames)) return {};
  return "must have 1 to 64 letters, digits, - and _";
}

std::string check_public_url(const std::string& url) {
  const bool has_scheme = url.starts_with("ws://") || url.starts_with("wss://");
  if (url.empty() || (has_scheme && !url.ends_with("//") && has_only(url, kUrlCharacters)))
    return {};
  return "must be a WebSocket URL, such as wss://a.example/ws";
}

Setting shown_as(Setting setting, std::string shown_default) {
  setting.shown_default = std::move(shown_default);
  return setting;
}

void add_group(std::vector<Setting>& all, const char* group, std::vector<Setting> settings) {
  for (Setting& setting : settings) {
    setting.group = group;
    all.push_back(std::move(setting));
  }
}

std::vector<Setting> server_group(ServeSettings& s) {
  return {
      text_setting("host", s.host, "ADDRESS",
                   "Address to listen on; 0.0.0.0: all addresses of the machine", check_host),
      number_setting<std::uint16_t>("port", s.port, 0, 65535,
                                    "Port to listen on; 0: any free port"),
      text_setting("tls_certificate", s.tls_certificate, "FILE",
                   "Certificate chain in PEM; enables TLS on the port (https and wss)"),
      text_setting("tls_key", s.tls_key, "FILE", "Private key of the certificate, in PEM"),
      list_setting("public_name", s.public_name, "NAMES",
                   "Names that clients may use besides localhost and numeric addresses: "
                   "vat.example,vat.example:8443",
                   check_public_name),
      list_setting("trusted_proxy", s.trusted_proxy, "NETWORKS",
                   "Proxies whose headers name the client: 10.0.0.1,fd00::/8", check_proxy),
      list_setting("allow_origin", s.allow_origin, "ORIGINS",
                   "Other origins whose pages may connect, and show the viewer in a frame: "
                   "https://a.example,https://b.example",
                   check_origin),
      text_setting("scene", s.scene, "SCENE",
                   "Scene of the first session: a file (a path with '/' or ending in '.json') or "
                   "the name of a catalogue scene"),
      shown_as(text_setting("scenes", s.scenes_folder, "FOLDER", "Folder of the scene catalogue"),
               "that of the program"),
      shown_as(text_setting("web", s.web_folder, "FOLDER", "Folder of the built viewer"),
               "that of the program"),
      number_setting<std::size_t>("threads", s.threads, 0, kMaxThreads,
                                  "Threads that compute sessions; 0: one per core"),
      number_setting<std::size_t>(
          "endpoints", s.endpoints, 1, kMaxEndpoints,
          "Threads that serve connections; one thread serves about a thousand viewers"),
      text_setting("isa", s.instructions, "SET",
                   "Instruction set: baseline, avx2, avx512, or best (the best of the machine)",
                   check_instructions),
      text_setting(
          "device", s.device, "DEVICE",
          "Device of the steps of new scenes: cpu, opencl:N of vat devices, opencl:N:fast, "
          "auto (the faster one of the CPU and the first device), or scene (the device that "
          "the scene names, otherwise the CPU)",
          check_device),
      word_setting("log_level", s.log_level, {"debug", "info", "warn", "error", "off"},
                   "Lowest level of logged messages"),
      word_setting("log_format", s.log_format, {"text", "json"},
                   "Format of the log on standard error; json: one object per line"),
  };
}

std::vector<Setting> access_group(ServeSettings& s) {
  return {
      word_setting("access", s.access, {"auto", "open", "token"},
                   "Access control: open: all clients; token: clients with a token; auto: open if "
                   "the host is 127.0.0.1 or ::1 and neither public_name nor trusted_proxy is set, "
                   "otherwise token"),
      text_setting(
          "admin_token_file", s.admin_token_file, "FILE",
          "File whose first line is the admin token; replaces the variable VAT_ADMIN_TOKEN"),
      text_setting("metrics_token_file", s.metrics_token_file, "FILE",
                   "File whose first line is a token that can only read /metrics"),
  };
}

std::vector<Setting> connection_limits(ServerLimits& limits) {
  return {
      number_setting<std::size_t>("max_connections", limits.max_connections, 1,
                                  kMaxConnectionSetting,
                                  "Open WebSockets; the server closes further ones"),
      number_setting<std::size_t>(
          "max_connections_per_address", limits.max_connections_per_address, 1,
          kMaxConnectionSetting,
          "Open WebSockets from one address; clients of a proxy share its address, unless "
          "trusted_proxy lists the proxy"),
      number_setting<std::size_t>("max_clients", limits.max_clients_per_session, 1,
                                  kMaxConnectionSetting, "Clients of one session"),
      number_setting<std::size_t>("max_grabs", limits.max_grabs_per_client, 1, kMaxGrabs,
                                  "Simultaneous grabs of one client"),
      number_setting<std::size_t>("max_message_bytes", limits.max_message_bytes, 1024, kMaxBytes,
                                  "Size of a message without scene or body"),
      number_setting<std::size_t>("max_scene_message_bytes", limits.max_scene_message_bytes, 1024,
                                  kMaxBytes, "Size of a message with a scene or a body"),
      number_setting<std::size_t>("max_message_depth", limits.max_message_depth, kMinDepth,
                                  kMaxMessageDepth,
                                  "Nesting depth of lists and objects in a message"),
      number_setting<std::size_t>("max_message_values", limits.max_message_values, 1000, 10'000'000,
                                  "Numbers, strings, lists and objects in a message"),
      number_setting<std::size_t>("max_commands_in_flight", limits.max_commands_in_flight, 1,
                                  1'000'000, "Unanswered commands of one client"),
      number_setting<std::size_t>("max_bytes_in_flight", limits.max_bytes_in_flight, 1024,
                                  kMaxBytes, "Total size of the unanswered commands of one client"),
      number_setting<std::size_t>("max_control_queue_bytes", limits.max_control_queue_bytes,
                                  16 * 1024, kMaxBytes,
                                  "Size of the replies and events that wait for one client; the "
                                  "server closes a connection that exceeds it"),
      number_setting<std::size_t>("max_queue_bytes_in_all", limits.max_queue_bytes_in_all,
                                  1024 * 1024, kMostMemory,
                                  "Memory of the messages that wait for all clients; beyond it, "
                                  "the server closes the connections with the longest queues"),
      time_setting("frame_patience_seconds", limits.frame_patience, 1, kMaxSeconds,
                   "Time without a frame acknowledgement after which the server closes a viewer's "
                   "connection"),
      time_setting("resume_seconds", limits.resume_time, 0, kMaxSeconds,
                   "Time after a disconnection within which a participant can resume"),
      time_setting("grab_idle_seconds", limits.grab_idle, 0.1, kMaxSeconds,
                   "Time without movement after which a grab ends"),
      number_setting<std::size_t>("max_tokens", limits.max_tokens, 1, 1'000'000,
                                  "Valid invitations and tickets"),
      number_setting<std::size_t>("max_recording_bytes", limits.max_recording_bytes, 1024,
                                  kMaxRecordingBytes, "Size of one exported recording"),
      number_setting<std::size_t>("max_download_bytes", limits.max_download_bytes, 1024,
                                  std::size_t{16} << 30,
                                  "Total size of exported recordings that wait for download"),
      time_setting("handshake_seconds", limits.handshake_time, 0.001, kMaxSeconds,
                   "Time limit of an HTTP request or a WebSocket upgrade"),
      time_setting("ping_seconds", limits.ping_interval, 0.001, kMaxSeconds,
                   "Interval of pings; the server closes a connection that sends nothing during "
                   "two intervals"),
  };
}

std::vector<Setting> rate_limits(ServerLimits& limits) {
  return {
      number_setting("max_queries_per_second", limits.max_queries_per_second, 0.01, kMaxPerSecond,
                     "Queries and frame acknowledgements"),
      number_setting("max_controls_per_second", limits.max_controls_per_second, 0.01, kMaxPerSecond,
                     "Control commands"),
      number_setting("max_pointer_moves_per_second", limits.max_pointer_moves_per_second, 0.01,
                     kMaxPerSecond, "Commands that follow a pointer"),
      number_setting("max_scenes_per_second", limits.max_scenes_per_second, 0.01, kMaxPerSecond,
                     "Messages with a scene or a body"),
      number_setting("max_reads_per_second", limits.max_reads_per_second, 0.01, kMaxPerSecond,
                     "Reads of the state of a session"),
      number_setting("max_message_bytes_per_second", limits.max_message_bytes_per_second, 1024,
                     kMaxBytesPerSecond, "Bytes of all messages"),
      number_setting("max_read_bytes_per_second", limits.max_read_bytes_per_second, 1024,
                     kMaxBytesPerSecond, "Bytes of the results of reads"),
      number_setting("max_read_seconds_per_second", limits.max_read_seconds_per_second, 0.001,
                     kMaxReadSeconds, "Processor time of reads, in seconds per second"),
      number_setting("burst_seconds", limits.burst_seconds, 0.1, kMaxSeconds,
                     "Burst size of each rate limit, as seconds at the full rate"),
      number_setting(
          "max_refusals_per_second", limits.max_refusals_per_second, 0.01, kMaxPerSecond,
          "Messages rejected by the rate limits; the server closes a connection that exceeds it"),
  };
}

std::vector<Setting> session_limits(ServerLimits& limits) {
  return {
      number_setting<std::size_t>(
          "max_memory", limits.max_memory, 0, kMostMemory,
          "Memory of the server in bytes, above which it rejects new sessions, scenes, bodies, "
          "recordings, saves and reads; 0: no limit"),
      number_setting<std::size_t>("max_sessions", limits.max_sessions, 1, kMaxSessions,
                                  "Simultaneous sessions"),
      number_setting<std::size_t>("max_sessions_per_address", limits.max_sessions_per_address, 1,
                                  kMaxSessions, "Simultaneous sessions created from one address"),
      number_setting<std::size_t>("max_particles", limits.max_particles, 1, kMaxParticles,
                                  "Particles of one session"),
      number_setting<std::size_t>("max_springs", limits.max_springs, 1, kMaxSprings,
                                  "Springs of one session"),
      number_setting<std::size_t>("max_particles_in_all", limits.max_particles_in_all, 1, kMaxInAll,
                                  "Particles of all sessions"),
      number_setting<std::size_t>("max_springs_in_all", limits.max_springs_in_all, 1, kMaxInAll,
                                  "Springs of all sessions"),
      number_setting<std::size_t>("max_particle_steps_per_tick", limits.max_particle_steps_per_tick,
                                  1, 1'000'000'000, "Particles of a session times steps per tick"),
      number_setting("max_session_read_bytes_per_second", limits.max_session_read_bytes_per_second,
                     1024, kMaxBytesPerSecond,
                     "Bytes of the results of reads, of all clients of a session"),
      number_setting("max_session_read_seconds_per_second",
                     limits.max_session_read_seconds_per_second, 0.001, kMaxReadSeconds,
                     "Processor time of reads, of all clients of a session, in seconds per second"),
      time_setting("hibernate_after", limits.hibernate_after, 0, kMaxAway,
                   "Seconds without participants after which a session hibernates; 0: never"),
      time_setting("expire_after", limits.expire_after, 0, kMaxAway,
                   "Seconds without participants after which a session ends, except the first "
                   "session; 0: never"),
      time_setting(
          "replay_expire_after", limits.replay_expire_after, 0.1, kMaxAway,
          "Seconds without participants after which a replay ends, if less than expire_after"),
  };
}

std::vector<Setting> saved_limits(ServerLimits& limits) {
  return {
      number_setting<std::size_t>("max_states_per_session", limits.max_states_per_session, 0,
                                  1'000'000, "Saved states of one session"),
      number_setting<std::size_t>("max_state_bytes_per_session", limits.max_state_bytes_per_session,
                                  1024, kMaxBytes, "Total size of the saved states of one session"),
      number_setting<std::size_t>("max_state_bytes_in_all", limits.max_state_bytes_in_all, 1024,
                                  kMaxInAll, "Total size of the saved states of all sessions"),
      number_setting<std::size_t>("max_scenes_per_address", limits.max_scenes_per_address, 0,
                                  1'000'000, "Scenes saved from one address"),
      number_setting<std::size_t>("max_scene_bytes_per_address", limits.max_scene_bytes_per_address,
                                  1024, kMaxBytes,
                                  "Total size of the scenes saved from one address"),
      number_setting<std::size_t>("max_scenes_in_all", limits.max_scenes_in_all, 0, 1'000'000,
                                  "Saved scenes"),
      number_setting<std::size_t>("max_scene_bytes_in_all", limits.max_scene_bytes_in_all, 1024,
                                  kMaxBytes, "Total size of the saved scenes"),
  };
}

std::vector<Setting> storage_group(ServeSettings& s) {
  constexpr std::size_t kMinBytes = 1024 * 1024;
  constexpr std::size_t kMaxBytesKept = std::size_t{1} << 40;
  return {
      text_setting("data", s.data, "FOLDER",
                   "Folder in which sessions persist; none: sessions exist in memory only"),
      word_setting("durability", s.durability, {"power", "process"},
                   "Failures that answered commands survive; power: also a power failure; process: "
                   "a crash of the server, without waits for the disk"),
      time_setting(
          "checkpoint_seconds", s.storage.checkpoint_after, 0.001, kMaxSeconds,
          "Computing time of all sessions that a recovery repeats at most; longer if storing "
          "states would take more than 5 % of the time, or after a power failure if "
          "checkpoints would exceed checkpoint_bytes_per_second; a quarter of it in a cluster"),
      number_setting("checkpoint_bytes_per_second", s.storage.checkpoint_bytes_per_second, 1024,
                     1e9, "Written bytes of all checkpoints; the default is 13 GB per day"),
      time_setting(
          "drain_seconds", s.drain_time, 0, kMaxSeconds,
          "Time between SIGTERM and the end of the server, in which clients stay connected"),
      number_setting<std::size_t>(
          "checkpoint_bytes", s.storage.checkpoint_bytes, kMinBytes, kMaxBytesKept,
          "Total size of one session's checkpoints; beyond it, the server thins older ones"),
      number_setting<std::size_t>(
          "checkpoint_bytes_in_all", s.storage.checkpoint_bytes_in_all, kMinBytes, kMaxBytesKept,
          "Total size of all checkpoints; beyond it, the server thins those of the session with "
          "the largest"),
      number_setting<std::size_t>(
          "log_bytes", s.storage.log_bytes, kMinBytes, kMaxBytesKept,
          "Size of one session's command log; beyond it, the server deletes the oldest part"),
  };
}

std::vector<Setting> cluster_group(ClusterSettings& cluster) {
  return {
      list_setting("cluster", cluster.servers, "URLS",
                   "NATS servers of the cluster that this server joins as a node: "
                   "nats://a:4222,nats://b:4222",
                   check_nats_url),
      text_setting("node", cluster.node, "NAME",
                   "Name of this node, unique in the cluster: letters, digits, - and _",
                   check_node),
      text_setting("public_url", cluster.public_url, "URL",
                   "URL at which clients of other nodes reach this node: wss://a.example/ws",
                   check_public_url),
      word_setting("route", cluster.route, {"redirect", "relay"},
                   "Clients of sessions on other nodes: this node redirects them, or relays their "
                   "messages and frames"),
      text_setting("cluster_tls_ca", cluster.tls_ca, "FILE",
                   "Trusted CA certificates of the NATS servers, in PEM"),
      text_setting("cluster_tls_certificate", cluster.tls_certificate, "FILE",
                   "Certificate of this node for the NATS servers, in PEM"),
      text_setting("cluster_tls_key", cluster.tls_key, "FILE",
                   "Private key of cluster_tls_certificate, in PEM"),
      text_setting("cluster_credentials", cluster.credentials, "FILE",
                   "Credentials of this node's NATS user"),
      text_setting("cluster_key_file", cluster.key_file, "FILE",
                   "File whose first line, at least 32 bytes, is the key with which all nodes sign "
                   "tokens; required with access by token; replaces the variable VAT_CLUSTER_KEY"),
  };
}

}  // namespace

std::vector<Setting> serve_settings(ServeSettings& target) {
  std::vector<Setting> all;
  add_group(all, "Server", server_group(target));
  add_group(all, "Access", access_group(target));
  add_group(all, "Storage", storage_group(target));
  add_group(all, "Cluster", cluster_group(target.cluster));
  add_group(all, "Limits of connections", connection_limits(target.limits));
  add_group(all, "Rate limits of a connection", rate_limits(target.limits));
  add_group(all, "Limits of sessions", session_limits(target.limits));
  add_group(all, "Limits of saved states and scenes", saved_limits(target.limits));
  return all;
}

}  // namespace vat
