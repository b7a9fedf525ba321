#include <CLI/CLI.hpp>
#include <iostream>

#include "tests/protocol/player.h"
#include "tests/protocol/server_process.h"

namespace {

using namespace vat::script;

struct Options {
  std::string program;
  std::string scenes;
  std::string scene;
  std::string script;
  std::string heading;  ///< of the exchange, where the script is a Markdown document
  double patience = 20;
  std::vector<std::pair<std::string, std::string>> captures;
};

/// The server's arguments: a script may begin with {"server": [arguments]}.
std::vector<std::string> server_arguments(const Options& options, std::vector<Line>& lines) {
  std::vector<std::string> arguments{"serve",        "--port",  "0",          "--scenes",
                                     options.scenes, "--scene", options.scene};
  if (lines.front().action.contains("server")) {
    for (const Json& word : lines.front().action["server"]) arguments.push_back(word);
    lines.erase(lines.begin());
  }
  return arguments;
}

void play(const Options& options) {
  const bool is_document = !options.heading.empty();
  std::vector<Line> lines =
      is_document ? read_exchange(options.script, options.heading) : read_script(options.script);
  ServerProcess server(options.program, server_arguments(options, lines));
  const auto patience =
      std::chrono::milliseconds(static_cast<std::int64_t>(options.patience * 1000));
  {
    Player player(
        [&](const ConnectRequest& request) {
          return connect_websocket(server.port(), request,
                                   std::chrono::steady_clock::now() + patience);
        },
        patience);
    for (const auto& [name, text] : options.captures) player.set('$' + name, text);
    if (is_document) lines.insert(lines.begin(), {"connect", {{"connect", "a"}}});
    player.play(lines);
    if (!server.is_running()) throw Failure("the server has ended");
  }
  if (const int status = server.stop(); status != 0) {
    throw Failure("the server ended with status " + std::to_string(status));
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Plays a script against a running server"};
  Options options;
  app.add_option("--program", options.program, "the vat program")->required();
  app.add_option("--scenes", options.scenes, "the catalogue's folder")->required();
  app.add_option("--scene", options.scene, "the first session's scene")->required();
  app.add_option("--set", options.captures, "a text for the script's \"$NAME\": NAME TEXT");
  app.add_option("--heading", options.heading, "play the exchange under this heading");
  app.add_option("--patience", options.patience, "seconds that a line waits");
  app.add_option("script", options.script, "a .jsonl script, or a Markdown document")->required();
  CLI11_PARSE(app, argc, argv);
  try {
    play(options);
  } catch (const std::exception& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
  return 0;
}
