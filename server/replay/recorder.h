#pragma once

#include <cstdint>

#include "server/replay/recording.h"
#include "server/storage/storage.h"

namespace vat {

/// What is kept of a session, as a recording: up to its newest checkpoint, or further where the
/// session was seen later. It tells nothing that lets anybody in. Throws StorageError; of kind full
/// where it would be more than kMaxRecordingBytes.
Recording record_session(Storage& storage, std::uint64_t session);

}  // namespace vat
