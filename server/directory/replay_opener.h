#pragma once

#include <memory>
#include <optional>
#include <string>

#include "server/directory/access_control.h"

namespace vat {

/// Source of a replay: a stored session, or an imported recording.
struct ReplaySource {
  std::optional<SessionId> session;
  std::optional<std::string> recording;  ///< name of an import; set if `session` is absent
  std::string name;                      ///< name of the new session; empty: name of the recording
};

/// Import of recordings, and creation of sessions that replay recordings. Thread-safe.
class ReplayOpener {
 public:
  ReplayOpener(ServerResources& resources, DirectoryTables& tables, Admission& admission,
               AccessControl& access);

  /// Adds a part of a file. The reply to the last part is sent after the whole file was read.
  std::optional<RpcResult> import_recording(PendingReply& reply, const Imports::Chunk& part);
  /// Creates a session that replays the source, and answers with the id of the session. Errors that
  /// are known immediately are returned instead.
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
  AccessControl& access_;
};

}  // namespace vat
