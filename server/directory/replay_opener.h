#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/directory/admission.h"

namespace vat {

/// Source of a replay: a stored session, or an imported recording.
struct ReplaySource {
  std::optional<SessionId> session;
  std::optional<std::string> recording;  ///< set if `session` is not
  std::string name;                      ///< of the new session; empty: the recording's
};

/// Imports recordings, and creates sessions that replay them. Safe to use from any thread.
class ReplayOpener {
 public:
  ReplayOpener(ServerResources& resources, DirectoryTables& tables, Admission& admission);

  /// Adds a part of a file. The last part is answered after the whole file is read.
  std::optional<RpcResult> import_recording(PendingReply& reply, const Imports::Chunk& part);
  /// Creates a session that replays the source, and answers with its id. Returns an error if that
  /// is known at once.
  std::optional<RpcError> open(PendingReply& reply, const ReplaySource& source);

 private:
  RpcResult read_import(const std::string& name, std::size_t size);
  std::optional<RpcError> refuse_source(const PendingReply& reply, const Client& client,
                                        const ReplaySource& source);
  void open_stored(PendingReply& reply, const ReplaySource& source, SessionCreator creator);
  void open_recording(PendingReply& reply, std::shared_ptr<const Recording> recording,
                      const std::string& name, SessionCreator creator);
  RpcResult make_replay(std::shared_ptr<const Recording> recording, const std::string& name,
                        SessionCreator creator);

  ServerResources& resources_;
  DirectoryTables& tables_;
  Admission& admission_;
};

}  // namespace vat
