#pragma once

#include "server/http/static_files.h"
#include "server/net/transport.h"

namespace vat {

/// Answers GET and HEAD for the viewer's files ("/" is "/index.html") and for "/healthz". Where
/// there is no viewer, "/" says how to build it.
HttpHandler make_http_site(StaticFiles viewer);

}  // namespace vat
