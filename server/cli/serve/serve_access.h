#pragma once

#include <string>

#include "core/support/result.h"
#include "server/access/access.h"
#include "server/settings/serve_settings.h"

namespace vat {

/// Access settings of a server.
struct ServeAccess {
  AccessSettings settings;
  std::string made_token;   ///< generated admin token; empty: none was generated
  std::string cluster_key;  ///< see ClusterSettings::key
};

/// Returns the access settings. Returns an error if a file cannot be read, if a token or the key of
/// the cluster is too short, or if the cluster uses access by token without a key.
Result<ServeAccess> serve_access(const ServeSettings& settings);
/// Logs a warning if access is open to other machines. Prints the link of a generated admin token
/// to standard output. `url` is the address of the viewer.
void tell_access(const ServeSettings& settings, const ServeAccess& access, const std::string& url);

}  // namespace vat
