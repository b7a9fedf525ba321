#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "protocol/client/connection/websocket_url.h"

namespace vat::script {

struct PlaySettings {
  /// Server for the scripts. If absent, each script gets a new server.
  std::optional<client::WebSocketUrl> server;
  client::TlsTrust trust;              ///< certificates for a server with TLS
  std::string program;                 ///< program that starts a server
  std::vector<std::string> arguments;  ///< followed by the arguments in the script's first line
  std::string heading;                 ///< heading of the script in a Markdown document
  std::chrono::milliseconds patience{20'000};                 ///< time limit of a line
  std::vector<std::pair<std::string, std::string>> captures;  ///< names without $, and values
  std::string transcript_folder;                              ///< "": no transcripts
};

/// Exception: the script requires a server with certain arguments, but another server was
/// specified.
struct NeedsOwnServer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Runs a file and returns the number of lines. Throws Failure if an expectation fails or the
/// server is unreachable. Throws ScriptError for an invalid script. Throws NeedsOwnServer.
std::size_t play_file(const std::string& path, const PlaySettings& settings);

}  // namespace vat::script
