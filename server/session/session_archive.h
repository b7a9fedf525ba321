#pragma once

#include <cstdint>
#include <string>

#include "server/session/core/saved_state.h"
#include "server/storage/storage.h"

/// Files and saved states of a session. These functions take their time and may run on any thread.
namespace vat {

/// Makes a download of all that is stored of a session, and returns the result of
/// recording.export. `tick` is the session's current tick. Throws StorageError.
RpcResult export_recording(const SessionEnvironment& environment, const std::string& session,
                           Storage& storage, std::uint64_t number, std::uint64_t tick);

/// Stores a moment of the session under a name, and returns the result of session.save. Throws
/// StorageError.
RpcResult save_state(const SessionEnvironment& environment, const std::string& session,
                     const MomentToSave& moment, const SaveState& save);

}  // namespace vat
