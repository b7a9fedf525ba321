#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "server/limits.h"
#include "server/settings/setting.h"
#include "server/storage/storage_limits.h"

namespace vat {

/// What `vat serve` can be told.
struct ServeSettings {
  std::string host = "127.0.0.1";  ///< a numeric address
  std::uint16_t port = 8080;       ///< 0: any free one
  std::string tls_certificate;     ///< file in PEM; empty: no TLS
  std::string tls_key;
  std::string allow_origin;  ///< with commas between
  std::string scene = "sliding-vat-liquid";
  std::string scenes_folder;
  std::string web_folder;
  std::size_t threads = 0;  ///< 0: one a core
  std::size_t endpoints = 1;
  std::string instructions = "best";  ///< or the name of a set
  std::string log_level = "info";
  std::string log_format = "text";  ///< or json
  std::string access = "auto";      ///< or "open", "token"
  std::string admin_token_file;     ///< empty: none
  ServerLimits limits;
  std::chrono::milliseconds drain_time{0};
  std::string data = "none";  ///< folder where sessions are kept, or "none"
  StorageLimits storage;
};

/// The parts of a list with commas between.
std::vector<std::string> split_origins(const std::string& list);

/// The one table of them: options, variables of the environment, members of a configuration file
/// and the page SETTINGS.md come from it. `target` must outlive it.
std::vector<Setting> serve_settings(ServeSettings& target);

}  // namespace vat
