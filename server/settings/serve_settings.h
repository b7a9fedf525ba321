#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/cluster/cluster_settings.h"
#include "server/messages/limits.h"
#include "server/settings/setting.h"
#include "server/storage/sqlite/storage_settings.h"

namespace vat {

/// Settings of `vat serve`.
struct ServeSettings {
  std::string host = "127.0.0.1";  ///< numeric address
  std::uint16_t port = 8080;       ///< 0: any free port
  std::string tls_certificate;     ///< PEM file; empty: no TLS
  std::string tls_key;
  std::vector<std::string> allow_origin;
  std::vector<std::string> public_name;
  std::vector<std::string> trusted_proxy;
  std::string scene = "sliding-vat-liquid";
  std::string scenes_folder;
  std::string web_folder;
  std::size_t threads = 0;  ///< 0: one per core
  std::size_t endpoints = 1;
  std::string instructions = "best";  ///< "best", or the name of an instruction set
  std::string device = "scene";       ///< "scene", or a text for parse_device()
  std::string log_level = "info";
  std::string log_format = "text";  ///< "text" or "json"
  std::string access = "auto";      ///< "auto", "open" or "token"
  std::string admin_token_file;     ///< empty: no file
  std::string metrics_token_file;   ///< empty: no file
  ServerLimits limits;
  std::chrono::milliseconds drain_time{0};
  std::string data = "none";  ///< folder for stored sessions, or "none"
  StorageSettings storage;
  std::string durability = "power";  ///< "power" or "process"
  ClusterSettings cluster;
};

/// Returns the table of all settings. Options, environment variables, members of a configuration
/// file and SETTINGS.md are generated from the table. `target` must outlive the table.
std::vector<Setting> serve_settings(ServeSettings& target);

}  // namespace vat
