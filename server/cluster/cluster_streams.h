#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "server/cluster/log_records.h"
#include "server/nats/stream.h"

namespace vat {

/// Headers of the messages in the streams of a cluster.
inline constexpr const char* kEpochHeader = "Vat-Epoch";
inline constexpr const char* kWriteHeader = "Vat-Write";  ///< unique for each write
inline constexpr const char* kPartHeader = "Vat-Part";    ///< see LogPart; absent: a whole message

/// Streams with the logs and states of a cluster's sessions. The connection must outlive them. A
/// log has its messages in two streams, so that the owner can write to the other one while the
/// servers elect a leader of a stream.
struct ClusterStreams {
  explicit ClusterStreams(NatsConnection& connection_in)
      : connection(connection_in),
        logs{Stream(connection, {"vat-log", "vat.log.*", Stream::Milliseconds(0), 0, {}}),
             Stream(connection,
                    {"vat-spare-log", "vat.spare-log.*", Stream::Milliseconds(0), 0, {}})},
        states(connection,
               {"vat-checkpoints", "vat.checkpoint.>", Stream::Milliseconds(0), 0, {}}) {}

  NatsConnection& connection;
  std::array<Stream, kLogStreams> logs;
  Stream states;
};

/// `stream` is the index of the stream in ClusterStreams::logs.
inline std::string log_subject(std::uint64_t session, std::size_t stream) {
  return (stream == 0 ? "vat.log." : "vat.spare-log.") + std::to_string(session);
}
inline std::string chunk_subject(std::uint64_t session) {
  return "vat.checkpoint." + std::to_string(session) + ".chunk";
}
inline std::string manifest_subject(std::uint64_t session) {
  return "vat.checkpoint." + std::to_string(session) + ".manifest";
}

}  // namespace vat
