#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vat {

inline constexpr const char* kSubprotocol = "vat.v1";

/// What a client asks for when it opens a WebSocket; headers that are missing are empty.
struct UpgradeRequest {
  std::string_view target;
  std::string_view host;
  std::string_view origin;
  std::string_view version;
  const std::vector<std::string>& subprotocols;
};

struct UpgradeRefusal {
  int status;
  const char* message;
};

/// Why the upgrade is refused; nothing where it is granted. A browser names the page's origin: only
/// pages that this server itself has served, and those of the allowed origins, may connect, or any
/// site could drive a user's server.
std::optional<UpgradeRefusal> refuse_upgrade(const UpgradeRequest& request,
                                             const std::vector<std::string>& allowed_origins);

}  // namespace vat
