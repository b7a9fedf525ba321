#pragma once

#include <functional>
#include <string>

#include "server/http/static_files.h"
#include "server/net/transport.h"
#include "server/server_phase.h"

namespace vat {

/// Where the answers about the server come from.
struct SiteSources {
  std::function<std::string()> metrics;  ///< the text of "/metrics"
  std::function<ServerPhase()> phase;
  std::string version;  ///< the JSON of "/version"
};

/// Answers GET and HEAD for the viewer's files ("/" is "/index.html"), and for
/// - "/healthz": 200 as long as the process answers;
/// - "/readyz": 200 where the server takes new sessions, 503 while it starts, recovers or drains;
/// - "/version" and "/metrics".
/// Where there is no viewer, "/" says how to build it.
HttpHandler make_http_site(StaticFiles viewer, SiteSources sources);

}  // namespace vat
