#pragma once

#include <string>

#include "core/support/result.h"
#include "server/access/access.h"
#include "server/settings/serve_settings.h"

namespace vat {

/// Who is let in, as the settings and the environment say.
struct ServeAccess {
  AccessSettings settings;
  std::string made_token;  ///< the admin's, where none was given and one is needed; else empty
};

/// Fails where the file cannot be read, or its token or that of VAT_ADMIN_TOKEN is too short.
Result<ServeAccess> serve_access(const ServeSettings& settings);
/// Says what a person has to know who starts a server of this kind. `url` is the viewer's.
void tell_access(const ServeSettings& settings, const ServeAccess& access, const std::string& url);

}  // namespace vat
