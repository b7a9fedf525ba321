#pragma once

#include <cstddef>

#include "server/history/recording.h"
#include "server/session/core/session_environment.h"

namespace vat {

/// Seeks random positions of a recording, first without and then with cached moments (MomentCache).
/// Prints the seek times and the memory of the moments.
void time_seeks(const Recording& recording, const SessionEnvironment& environment,
                std::size_t count);

}  // namespace vat
