#pragma once

#include <chrono>
#include <cstddef>
#include <memory>
#include <string>
#include <string_view>

#include "core/support/result.h"
#include "protocol/scene/scene_json.h"
#include "server/directory/server_settings.h"
#include "server/transport/transport.h"

namespace vat {

class Clock;
class Downloads;

/// The server behind the transport: sessions, clients and the methods of PROTOCOL.md. Safe to use
/// from any thread. See server/THREADS.md.
class SessionServer : public ConnectionHandler {
 public:
  /// `catalogue` and `clock` must outlive this. Throws StorageError if the data folder cannot be
  /// used.
  SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock);
  ~SessionServer() override;
  SessionServer(const SessionServer&) = delete;
  SessionServer& operator=(const SessionServer&) = delete;

  /// Starts to recover the sessions of the data folder, and returns their number.
  std::size_t recover();
  /// False while sessions are being recovered, and after drain().
  bool is_ready() const;

  /// Starts a session, playing. Fails with the scene's errors, or with the code limit_reached.
  Result<SessionId> create_session(std::string name, const Scene& scene);

  /// Returns the metrics in Prometheus' text format.
  std::string metrics() const;

  /// Admits no connections, sessions and joins from now on. Tells clients that the server ends in
  /// `time`. Returns when the time is over or the last client has left.
  void drain(std::chrono::milliseconds time);

  /// Files that clients fetch by HTTP.
  Downloads& downloads();

  /// Waits for the work posted before the call: creations of sessions, their turns, the frames of
  /// these turns, and writes to the data folder.
  void flush();

  // For TransportSettings.
  void count_refusal(std::string_view limit);
  void count_close(std::uint16_t code);

  /// Ends all sessions after their current ticks, sends session.closed, and joins the threads.
  /// Later calls have no effect. The data folder is then complete.
  void stop();

  void opened(std::shared_ptr<Connection> connection) override;
  void text_received(ConnectionId id, std::string_view message) override;
  void binary_received(ConnectionId id, std::string_view message) override;
  void closed(ConnectionId id) override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace vat
