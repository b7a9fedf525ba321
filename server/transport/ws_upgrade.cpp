#include "server/transport/ws_upgrade.h"

#include <algorithm>
#include <cstddef>

#include "server/support/header_text.h"

namespace vat {

namespace {

/// Compares as text, because both omit the scheme's default port.
bool same_origin(std::string_view origin, std::string_view host) {
  constexpr std::string_view kSeparator = "://";
  const std::size_t scheme_end = origin.find(kSeparator);
  if (scheme_end == std::string_view::npos)
    return false;  // for example "null" for a sandboxed page
  return equal_ignoring_case(origin.substr(scheme_end + kSeparator.size()), host);
}

}  // namespace

std::optional<HttpRefusal> refuse_upgrade(const UpgradeRequest& request,
                                          const std::vector<std::string>& allowed_origins) {
  if (request.target.substr(0, request.target.find('?')) != "/ws") {
    return HttpRefusal{400, "WebSocket connections are served at /ws only.\n"};
  }
  if (request.version != kWebSocketVersion) {
    return HttpRefusal{400, "Sec-WebSocket-Version must be 13.\n"};
  }
  const auto is_named = [&](const std::string& allowed) {
    return equal_ignoring_case(allowed, request.origin);
  };
  if (!request.origin.empty() && !same_origin(request.origin, request.host) &&
      std::none_of(allowed_origins.begin(), allowed_origins.end(), is_named)) {
    return HttpRefusal{403, "The page comes from another origin than this server.\n"};
  }
  const auto& offered = request.subprotocols;
  if (std::find(offered.begin(), offered.end(), kSubprotocol) == offered.end()) {
    return HttpRefusal{400, "Sec-WebSocket-Protocol must offer vat.v1.\n"};
  }
  return std::nullopt;
}

}  // namespace vat
