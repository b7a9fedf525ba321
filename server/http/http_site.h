#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/static_files.h"
#include "server/operations/server_phase.h"
#include "server/transport/transport.h"

namespace vat {

/// Sources of the responses about the server.
struct SiteSources {
  std::function<std::string()> metrics;     ///< returns the text of "/metrics"
  std::function<std::string()> slow_ticks;  ///< returns the JSON text of "/slow-ticks"
  /// Returns whether a request with this header Authorization may read "/metrics" and
  /// "/slow-ticks".
  std::function<bool(std::string_view authorization)> may_read_metrics;
  std::function<ServerPhase()> phase;
  std::function<std::string()> health;  ///< returns the JSON text of "/healthz"
  std::string version;                  ///< JSON text of "/version"
  /// Other origins whose pages may show this site in a frame, such as "https://a.example".
  std::vector<std::string> framing_origins{};
};

/// Returns a handler for GET and HEAD:
/// - files of the viewer ("/" is "/index.html") in the encoding that the client prefers, with a tag
///   for If-None-Match. Without a viewer, "/" describes how to build it.
/// - "/healthz": 200 while the process runs, with the state of the storage; 503 if another process
///   has replaced it in its cluster.
/// - "/readyz": 200 if the server admits sessions, 503 in every other phase.
/// - "/version".
/// - "/metrics" and "/slow-ticks": 401 if the request may not read them.
HttpHandler make_http_site(StaticFiles viewer, SiteSources sources);

}  // namespace vat
