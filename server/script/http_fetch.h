#pragma once

#include <chrono>
#include <string>

#include "protocol/client/connection/websocket_url.h"
#include "server/script/pattern.h"

namespace vat::script {

/// Sends GET for `path` to the server at `url`. Returns the response in the form that scripts use:
/// `status`, `size` (bytes of the body), `headers` (keys in lower case), and `text` (the body).
/// `text` is absent for `application/octet-stream`. Throws std::runtime_error if no response
/// arrives before the deadline.
Json fetch_http(const client::WebSocketUrl& url, const client::TlsTrust& trust,
                const std::string& path, std::chrono::steady_clock::time_point deadline);

}  // namespace vat::script
