#pragma once

#include <chrono>
#include <string>

#include "server/script/pattern.h"
#include "server/script/websocket_url.h"

namespace vat::script {

/// Sends GET for `path` to the server at `url`. Returns the response in the form that scripts use:
/// `status`, `size` (bytes of the body), `headers` (keys in lower case), and `text` (the body).
/// `text` is absent for `application/octet-stream`. Throws std::runtime_error if no response
/// arrives before the deadline.
Json fetch_http(const WebSocketUrl& url, const TlsTrust& trust, const std::string& path,
                std::chrono::steady_clock::time_point deadline);

}  // namespace vat::script
