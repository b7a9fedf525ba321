#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/script/pattern.h"
#include "server/script/websocket_url.h"

namespace vat::script {

struct PlaySettings {
  /// Server to play against. Absent: a new server for each script.
  std::optional<WebSocketUrl> server;
  TlsTrust trust;                      ///< for a server with TLS
  std::string program;                 ///< starts a server, with these arguments first
  std::vector<std::string> arguments;  ///< followed by those in the script's first line
  std::string heading;                 ///< of the script, if the file is a Markdown document
  std::chrono::milliseconds patience{20'000};                 ///< time limit of a line
  std::vector<std::pair<std::string, std::string>> captures;  ///< names without $, and texts
  std::string transcript_folder;                              ///< "": no transcripts
};

/// The script needs a server with certain arguments, but another server was given.
struct NeedsOwnServer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Plays a file and returns the number of its lines. Throws Failure if a line is not met or the
/// server cannot be reached, ScriptError for an invalid script, and NeedsOwnServer.
std::size_t play_file(const std::string& path, const PlaySettings& settings);

}  // namespace vat::script
