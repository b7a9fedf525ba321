#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/history/recording.h"
#include "server/storage/storage.h"

namespace vat {

/// Returns a recording of a stored session, up to the newest checkpoint or stored progress. The
/// recording contains no tokens. Returns nothing if more than `max_bytes` are stored. Throws
/// StorageError.
std::optional<Recording> record_session(Storage& storage, std::uint64_t session,
                                        std::size_t max_bytes);

}  // namespace vat
