#pragma once

#include <chrono>
#include <string>

#include "server/script/pattern.h"
#include "server/script/websocket_url.h"

namespace vat::script {

/// Sends GET for `path` to the server at `url`. The answer as scripts see it: `status`, `size` of
/// the body in bytes, `headers` by their names in small letters, and `text`, the body, unless it is
/// `application/octet-stream`. Throws std::runtime_error if none comes by the deadline.
Json fetch_http(const WebSocketUrl& url, const TlsTrust& trust, const std::string& path,
                std::chrono::steady_clock::time_point deadline);

}  // namespace vat::script
