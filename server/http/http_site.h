#pragma once

#include <functional>
#include <string>

#include "server/http/static_files.h"
#include "server/operations/server_phase.h"
#include "server/transport/transport.h"

namespace vat {

/// Sources of the answers about the server.
struct SiteSources {
  std::function<std::string()> metrics;  ///< the text of "/metrics"
  std::function<ServerPhase()> phase;
  std::string version;  ///< the JSON of "/version"
};

/// Returns a handler for GET and HEAD of the viewer's files ("/" is "/index.html"), and of
/// "/healthz": 200 while the process runs; "/readyz": 200 if the server admits sessions, 503 while
/// it starts, recovers or drains; "/version" and "/metrics". Without a viewer, "/" describes how to
/// build it.
HttpHandler make_http_site(StaticFiles viewer, SiteSources sources);

}  // namespace vat
