#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "core/support/instruction_set.h"
#include "core/support/result.h"
#include "protocol/scene/scene_json.h"
#include "server/access/access.h"
#include "server/limits.h"
#include "server/net/transport.h"
#include "server/storage/storage_limits.h"

namespace vat {

class Clock;
class Downloads;

/// Names a session for the life of the server; never used twice.
using SessionId = std::string;

struct ServerSettings {
  ServerLimits limits;
  std::string version;  ///< told by server.info
  InstructionSet instructions = best_instruction_set();
  std::size_t threads = 0;  ///< that step the sessions; 0: as many as the machine has cores
  AccessSettings access;
  std::string data_folder;  ///< where sessions are kept; empty: in memory alone
  StorageLimits storage;
  /// Ends the server soon, once clients have had so much time, or else its usual one, which it
  /// gives; may be called from any thread. Empty: no client ends it.
  std::function<std::chrono::milliseconds(std::optional<std::chrono::milliseconds>)> end;
};

/// The server behind the transport: its sessions, its clients, and the methods of PROTOCOL.md.
///
/// The transport's thread reads messages and answers what needs no session; commands go to the
/// session's inbox. All sessions share one pool of threads, each on a strand of its own, so that a
/// session is never run by two threads at once. Every function may be called from any thread.
class SessionServer : public ConnectionHandler {
 public:
  /// `catalogue` and `clock` must outlive this. Throws StorageError if the data folder cannot be
  /// used.
  SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock);
  ~SessionServer() override;
  SessionServer(const SessionServer&) = delete;
  SessionServer& operator=(const SessionServer&) = delete;

  /// Brings the sessions back that the data folder has, in the background; how many there are.
  std::size_t recover();
  /// Whether all that could be brought back are there.
  bool is_ready() const;

  /// Starts a session, playing. Fails with the scene's errors, or with the code limit_reached.
  Result<SessionId> create_session(std::string name, const Scene& scene);

  /// What the server has counted and has now, in Prometheus' text format.
  std::string metrics() const;

  /// Refuses new connections, sessions and joins from now on. Tells clients that the server ends in
  /// `time`. Returns when the time is over or the last client has gone.
  void drain(std::chrono::milliseconds time);

  /// Files that were made for clients, who fetch them by HTTP.
  Downloads& downloads();

  /// Waits for the work posted before the call: creations of sessions, their turns, the frames of
  /// these turns, and writes to the data folder.
  void flush();

  // Of the transport; see TransportSettings.
  void count_refusal(std::string_view limit);
  void count_close(std::uint16_t code);

  /// Ends all sessions, tells their clients by session.closed, and joins the threads; a tick that
  /// runs is ended first. Nothing that comes in later has an effect. What is kept in the data
  /// folder is whole then.
  void stop();

  void opened(std::shared_ptr<Connection> connection) override;
  void text_received(ConnectionId id, std::string_view message) override;
  void binary_received(ConnectionId id, std::string_view message) override;
  void closed(ConnectionId id) override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vat
