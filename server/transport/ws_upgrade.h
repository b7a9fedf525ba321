#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vat {

inline constexpr const char* kSubprotocol = "vat.v1";
inline constexpr const char* kWebSocketVersion = "13";  ///< RFC 6455

/// Headers of a WebSocket upgrade. Missing headers are empty.
struct UpgradeRequest {
  std::string_view target;
  std::string_view host;
  std::string_view origin;
  std::string_view version;
  const std::vector<std::string>& subprotocols;
};

struct HttpRefusal {
  int status;
  const char* message;
};

/// Returns the reason for a refusal, or nothing. Only pages of this server and of allowed origins
/// may connect. Otherwise, pages of other sites could control a user's server.
std::optional<HttpRefusal> refuse_upgrade(const UpgradeRequest& request,
                                          const std::vector<std::string>& allowed_origins);

}  // namespace vat
