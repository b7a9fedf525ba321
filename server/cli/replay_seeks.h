#pragma once

#include <cstddef>

#include "server/replay/recording.h"
#include "server/session/session_environment.h"

namespace vat {

/// Goes to so many random positions of a recording, and again once moments have been filled in as
/// a server does it; prints how long that took, and what is kept.
void time_seeks(const Recording& recording, const SessionEnvironment& environment,
                std::size_t count);

}  // namespace vat
