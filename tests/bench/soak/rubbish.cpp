#include "tests/bench/soak/rubbish.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "server/rpc/method_table.h"

namespace vat::bench {
namespace {

constexpr std::array kNames{"session", "body",  "particle", "target", "grab",     "force",
                            "number",  "speed", "gravity",  "name",   "bodies",   "resume",
                            "token",   "role",  "position", "every",  "max_error"};

/// Returns whether a method is excluded: methods that end objects of other clients, create sessions
/// without limit, or create files that are kept for a minute.
bool is_spared(std::string_view method) {
  constexpr std::array kSpared{"session.create", "scene.load", "replay.open", "recording.export"};
  return std::ranges::find(kSpared, method) != kSpared.end();
}

}  // namespace

std::size_t Rubbish::below(std::size_t end) {
  return std::uniform_int_distribution<std::size_t>(0, end - 1)(chance_);
}

std::string Rubbish::bytes() {
  std::string bytes(below(400), ' ');
  for (char& byte : bytes) byte = static_cast<char>(below(256));
  return bytes;
}

std::string Rubbish::text() {
  if (below(40) == 0) return bytes();  // rarely UTF-8, so it ends the connection
  std::string text = request();
  switch (below(4)) {
    case 0:
      text.resize(below(text.size()));
      break;
    case 1:
      text[below(text.size())] = static_cast<char>(' ' + below(90));
      break;
    default:;
  }
  return text;
}

std::string Rubbish::request() {
  const auto methods = all_methods();
  std::string_view method = methods[below(methods.size())].row.name;
  if (is_spared(method)) method = "server.info";
  Json params = Json::object();
  for (std::size_t i = below(5); i > 0; --i) params[kNames[below(kNames.size())]] = value(0);
  Json request{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}};
  if (below(4) != 0) request["id"] = value(0);
  return request.dump();
}

Json Rubbish::value(int depth) {
  constexpr int kMaxDepth = 3;
  constexpr std::array kNumbers{0.0, 1.0, 2.0, -1.0, 0.5, 1e-300, 1e300, 4294967296.0};
  switch (below(depth < kMaxDepth ? 9 : 6)) {
    case 0:
      return nullptr;
    case 1:
      return below(2) == 0;
    case 2:
      return below(4);
    case 3:
    case 4:
      return kNumbers[below(kNumbers.size())];
    case 5:
      return "s" + std::to_string(below(5));
    case 6:
      return Json{{kNames[below(kNames.size())], value(depth + 1)}};
    default:
      return Json::array({value(depth + 1), value(depth + 1), value(depth + 1)});
  }
}

void send_raw(std::uint16_t port, const std::string& bytes) {
  const int file = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  const bool is_open =
      connect(file, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  if (is_open) send(file, bytes.data(), bytes.size(), MSG_NOSIGNAL);  // the server may stop reading
  close(file);
  if (!is_open) throw std::runtime_error("the server's port is closed");
}

}  // namespace vat::bench
