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
  /// The server to play against; none: one that is started for each script and stopped after it.
  std::optional<WebSocketUrl> server;
  TlsTrust trust;                      ///< of a server with TLS
  std::string program;                 ///< that starts such a one, with these arguments first
  std::vector<std::string> arguments;  ///< and what the script's first line asks for behind them
  std::string heading;                 ///< of the script, where the file is a Markdown document
  std::chrono::milliseconds patience{20'000};                 ///< for a line
  std::vector<std::pair<std::string, std::string>> captures;  ///< names, without $, and texts
  std::string transcript_folder;                              ///< "": no transcripts
};

/// The script needs a server with arguments of its own, and another was given.
struct NeedsOwnServer : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Plays one file; the number of its lines. Throws Failure where a line is not met or a server ends
/// or cannot be reached, ScriptError for a mistake in the file, and NeedsOwnServer.
std::size_t play_file(const std::string& path, const PlaySettings& settings);

}  // namespace vat::script
