#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>

#include "server/replay/recording.h"
#include "server/storage/storage.h"

namespace vat {

/// What is kept of a session, as a recording: up to its newest checkpoint, or further where the
/// session was seen later. It tells nothing that lets anybody in. Nothing where more than so many
/// bytes are kept. Throws StorageError.
std::optional<Recording> record_session(Storage& storage, std::uint64_t session,
                                        std::size_t max_bytes);

}  // namespace vat
