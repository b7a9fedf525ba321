#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/history/recording.h"
#include "server/storage/storage.h"

namespace vat {

/// Makes a recording of a stored session, up to its newest checkpoint or stored progress. It
/// contains no tokens. Returns nothing if more than `most` bytes are stored. Throws StorageError.
std::optional<Recording> record_session(Storage& storage, std::uint64_t session,
                                        std::size_t max_bytes);

}  // namespace vat
