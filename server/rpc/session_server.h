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

/// Server behind the transport: sessions, clients and the methods of PROTOCOL.md. Thread-safe. See
/// server/THREADS.md.
class SessionServer : public ConnectionHandler {
 public:
  /// `catalogue` and `clock` must outlive the server. Throws StorageError if the data folder cannot
  /// be used.
  SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock);
  ~SessionServer() override;
  SessionServer(const SessionServer&) = delete;
  SessionServer& operator=(const SessionServer&) = delete;

  /// Starts the recovery of the stored sessions and returns their number.
  std::size_t recover();
  /// Returns false during the recovery of sessions and after drain().
  bool is_ready() const;
  /// Returns whether another process is now this node of the cluster.
  bool is_replaced() const;

  /// Creates a playing session. Returns the errors of the scene, or the error limit_reached.
  Result<SessionId> create_session(std::string name, const Scene& scene);

  /// Returns the metrics in the text format of Prometheus.
  std::string metrics() const;
  /// Returns the last slow ticks in the trace event format of Chrome.
  std::string slow_ticks() const;

  /// Returns the state of the storage as a JSON text for /healthz.
  std::string health() const;

  /// Refuses new connections, sessions and joins. Informs clients that the server ends after
  /// `time`. Returns after `time`, or as soon as the last client has left.
  void drain(std::chrono::milliseconds time);

  /// Returns the files that clients can download by HTTP.
  Downloads& downloads();
  /// Returns a handler for the downloads of this node and of the other nodes of its cluster. The
  /// handler passes other requests to `site`.
  HttpHandler serve_downloads(HttpHandler site);

  /// Waits for all work posted before the call: creations of sessions, turns, their frames, and
  /// writes to the data folder.
  void flush();

  // Callbacks for TransportSettings.
  void count_refusal(std::string_view limit);
  void count_close(std::uint16_t code);

  /// Ends all sessions after their current ticks, sends session.closed, and joins the threads. The
  /// data folder is then complete. Later calls have no effect.
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
