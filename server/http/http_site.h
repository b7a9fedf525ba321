#pragma once

#include <functional>
#include <string>

#include "server/http/static_files.h"
#include "server/net/transport.h"

namespace vat {

/// Gives the text of "/metrics".
using MetricsSource = std::function<std::string()>;

/// Answers GET and HEAD for the viewer's files ("/" is "/index.html"), for "/healthz" and for
/// "/metrics". Where there is no viewer, "/" says how to build it.
HttpHandler make_http_site(StaticFiles viewer, MetricsSource metrics);

}  // namespace vat
