#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "server/cli/common/command.h"
#include "server/cli/common/commands.h"
#include "server/cli/common/data_folders.h"
#include "server/cli/common/option_checks.h"
#include "server/cli/common/scene_argument.h"
#include "server/script/pattern.h"
#include "server/script/play_file.h"

namespace vat {

namespace {

constexpr const char* kScriptFooter = R"(A script is a file of JSON lines. protocol/SCRIPTS.md
describes the format, and tests/protocol/scripts has examples. Without --server, each script is
played against a separate server on a free port.

Exit codes: 0 all lines succeeded, 1 a line failed or there is no server, 2 wrong usage or an
invalid script.)";

constexpr double kMaxPatience = 86'400;  // [s] a day

struct ScriptOptions {
  std::vector<std::string> files;
  std::string server;
  std::string scene = "sliding-vat-liquid";
  std::string scenes_folder = installed_scenes_folder();
  double patience = 20;
  script::PlaySettings play;
};

std::string check_url(const std::string& text) {
  try {
    client::read_websocket_url(text);
    return {};
  } catch (const std::invalid_argument& fault) {
    return fault.what();
  }
}

/// Plays a file and prints the result. Returns kExitOk also for a skipped file.
int play(const std::string& path, const script::PlaySettings& settings, bool& was_played) {
  was_played = true;
  try {
    const std::size_t lines = script::play_file(path, settings);
    std::cout << path << ": " << lines << " lines, all met" << std::endl;
    return kExitOk;
  } catch (const script::NeedsOwnServer& reason) {
    was_played = false;
    std::cout << path << ": skipped: it " << reason.what() << std::endl;
    return kExitOk;
  } catch (const script::ScriptError& mistake) {
    std::cerr << path << ": a mistake in the script\n" << mistake.what() << '\n';
    return kExitUsage;
  } catch (const std::runtime_error& failure) {
    std::cerr << path << ": failed\n" << failure.what() << '\n';
    return kExitFailed;
  }
}

/// Returns false if an option for trusted certificates is given for a server without TLS.
bool is_trust_of_use(const script::PlaySettings& settings) {
  const bool is_given = !settings.trust.authority_file.empty() || settings.trust.is_unchecked;
  return !is_given || !settings.server || settings.server->is_secure;
}

int play_all(ScriptOptions& options) {
  script::PlaySettings& settings = options.play;
  settings.patience = std::chrono::milliseconds(static_cast<std::int64_t>(options.patience * 1000));
  if (!options.server.empty()) settings.server = client::read_websocket_url(options.server);
  if (!is_trust_of_use(settings)) {
    std::cerr << "--ca and --insecure apply to servers with TLS, at wss://\n";
    return kExitUsage;
  }
  settings.program = "/proc/self/exe";
  settings.arguments = {"serve",   "--port",      "0",           "--scenes", options.scenes_folder,
                        "--scene", options.scene, "--log-level", "error"};
  int exit_code = kExitOk;
  bool any_was_played = false;
  for (const std::string& file : options.files) {
    bool was_played = false;
    exit_code = std::max(exit_code, play(file, settings, was_played));
    any_was_played = any_was_played || was_played;
  }
  if (any_was_played) return exit_code;
  std::cerr << "none of the scripts can be played against a running server\n";
  return kExitUsage;
}

void add_script_options(CLI::App& command, ScriptOptions& options) {
  command.add_option("file", options.files, "Scripts, in .jsonl")->required();
  command
      .add_option(
          "--server", options.server,
          "Address of a running server: ws://HOST[:PORT][/PATH], by default port 80, /ws; or "
          "wss:// over TLS, by default port 443")
      ->check(CLI::Validator(check_url, "URL"));
  CLI::Option* authorities = command
                                 .add_option("--ca", options.play.trust.authority_file,
                                             "Trusted certificates in PEM, in place of the "
                                             "system's: of authorities or of the server")
                                 ->check(CLI::ExistingFile);
  command
      .add_flag("--insecure", options.play.trust.is_unchecked,
                "Do not verify the certificate of a server with TLS; a third party can then read "
                "and change all messages")
      ->excludes(authorities);
  command
      .add_option("--scene", options.scene,
                  "Scene of the first session of a started server. " + std::string(kSceneHelp))
      ->capture_default_str();
  command.add_option("--scenes", options.scenes_folder,
                     "Folder of the scene catalogue of a started server");
  command.add_option("--patience", options.patience, "Time limit of a line [s]")
      ->check(real_in(0, kMaxPatience))
      ->capture_default_str();
  command.add_option("--set", options.play.captures,
                     "NAME TEXT: value of \"$NAME\" in the scripts");
  command.add_option("--heading", options.play.heading,
                     "Play the script below this heading of a Markdown document");
  command
      .add_option("--transcript", options.play.transcript_folder,
                  "Folder for the sent and received messages, one file per script")
      ->envname("VAT_TRANSCRIPT");
}

}  // namespace

void add_script_command(CLI::App& app, int& exit_code) {
  CLI::App* command =
      app.add_subcommand("script", "Play scripts of the protocol against a server and check it");
  const auto options = std::make_shared<ScriptOptions>();
  add_script_options(*command, *options);
  command->footer(kScriptFooter);
  command->callback([options, &exit_code] { exit_code = play_all(*options); });
}

}  // namespace vat
