#include "server/script/play_file.h"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <memory>

#include "server/script/http_fetch.h"
#include "server/script/player.h"
#include "server/script/server_process.h"

namespace vat::script {
namespace {

/// Takes the arguments out that a first line {"server": [...]} has.
std::vector<std::string> take_server_arguments(std::vector<Line>& lines) {
  const Line first = lines.front();
  if (!first.action.contains("server")) return {};
  const Json& words = first.action["server"];
  const bool texts =
      words.is_array() && std::ranges::all_of(words, [](const Json& w) { return w.is_string(); });
  if (!texts || first.action.size() > (first.action.contains("comment") ? 2U : 1U)) {
    throw ScriptError(first.place + ": \"server\" needs a list of arguments, and stands alone");
  }
  lines.erase(lines.begin());
  return words.get<std::vector<std::string>>();
}

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += ' ' + word;
  return text;
}

/// A folder for the server's files, as long as it runs.
struct OwnFolder {
  OwnFolder() {
    const std::string pattern = "vat-script-" + std::string(6, 'X');  // as mkdtemp requires
    path = (std::filesystem::temp_directory_path() / pattern).string();
    if (mkdtemp(path.data()) == nullptr) throw std::runtime_error("no temporary folder");
  }
  ~OwnFolder() {
    std::error_code ignored;  // nothing depends on the removal
    std::filesystem::remove_all(path, ignored);
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  std::string path;
};

/// Named as the file is, and the heading in it.
std::unique_ptr<Transcript> open_transcript(const std::string& path, const PlaySettings& settings) {
  if (settings.transcript_folder.empty()) return {};
  std::string name = std::filesystem::path(path).stem().string();
  for (const char c : settings.heading) {
    if (std::isalnum(static_cast<unsigned char>(c)) != 0) name += c;
  }
  return std::make_unique<Transcript>(settings.transcript_folder, name);
}

/// Connects as connect_websocket(). The error of an untrusted server names the options of the
/// command.
client::Connected connect(const client::ConnectRequest& request, const client::WebSocketUrl& url,
                          const PlaySettings& settings) try {
  return client::connect_websocket(url, settings.trust, request,
                                   std::chrono::steady_clock::now() + settings.patience);
} catch (const client::UntrustedServer& error) {
  throw std::runtime_error(error.what() + std::string("; --ca FILE sets the trusted certificates, "
                                                      "--insecure disables the verification"));
}

void play_lines(const std::string& path, const std::vector<Line>& lines,
                const client::WebSocketUrl& url, const PlaySettings& settings) {
  const auto transcript = open_transcript(path, settings);
  Player player(
      [&](const client::ConnectRequest& request) { return connect(request, url, settings); },
      settings.patience);
  player.fetch_by([&](const std::string& target, client::Deadline deadline) {
    return fetch_http(url, settings.trust, target, deadline);
  });
  if (transcript) player.record(*transcript);
  for (const auto& [name, text] : settings.captures) player.set('$' + name, text);
  player.play(lines);
}

void play_with_own_server(const std::string& path, const std::vector<Line>& lines,
                          const std::vector<std::string>& arguments, const PlaySettings& settings) {
  const OwnFolder folder;
  std::vector<std::string> all = settings.arguments;
  for (const std::string& word : arguments) all.push_back(word == "$folder" ? folder.path : word);
  ServerProcess server(settings.program, all);
  play_lines(path, lines, {"127.0.0.1", std::to_string(server.port()), "/ws", server.is_secure()},
             settings);
  if (!server.is_running()) throw Failure("the server has ended");
  if (const int status = server.stop(); status != 0) {
    throw Failure("the server ended with status " + std::to_string(status));
  }
}

}  // namespace

std::size_t play_file(const std::string& path, const PlaySettings& settings) {
  std::vector<Line> lines =
      settings.heading.empty() ? read_script(path) : read_document(path, settings.heading);
  const std::size_t count = lines.size();
  const std::vector<std::string> arguments = take_server_arguments(lines);
  if (!settings.server) {
    play_with_own_server(path, lines, arguments, settings);
  } else if (arguments.empty()) {
    play_lines(path, lines, *settings.server, settings);
  } else {
    throw NeedsOwnServer("needs a separate server, with" + joined(arguments));
  }
  return count;
}

}  // namespace vat::script
