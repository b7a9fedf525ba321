#pragma once

#include <cstdint>
#include <string>

#include "server/session/core/saved_state.h"
#include "server/storage/storage.h"

/// Files and saved states of a session. These functions are slow and may run on any thread.
namespace vat {

/// Creates a download of the session's stored data. Returns the result of recording.export. `tick`
/// is the session's current tick. Throws StorageError.
RpcResult export_recording(const SessionEnvironment& environment, const std::string& session,
                           Storage& storage, std::uint64_t number, std::uint64_t tick);

/// Stores a snapshot of the session under a name. Returns the result of session.save. Throws
/// StorageError.
RpcResult save_state(const SessionEnvironment& environment, const std::string& session,
                     const MomentToSave& moment, const std::string& name,
                     const std::string& saved_by);

}  // namespace vat
