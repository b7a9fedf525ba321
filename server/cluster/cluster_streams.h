#pragma once

#include <cstdint>
#include <string>

#include "server/nats/stream.h"

namespace vat {

/// Headers of the messages in the streams of a cluster.
inline constexpr const char* kEpochHeader = "Vat-Epoch";
inline constexpr const char* kWriteHeader = "Vat-Write";  ///< unique for each write
inline constexpr const char* kPartHeader = "Vat-Part";    ///< see LogPart; absent: a whole message

/// Streams with the logs and states of a cluster's sessions. The connection must outlive them.
struct ClusterStreams {
  explicit ClusterStreams(NatsConnection& connection_in)
      : connection(connection_in),
        logs(connection, {"vat-log", "vat.log.*", Stream::Milliseconds(0), 0, {}}),
        states(connection,
               {"vat-checkpoints", "vat.checkpoint.>", Stream::Milliseconds(0), 0, {}}) {}

  NatsConnection& connection;
  Stream logs;
  Stream states;
};

inline std::string log_subject(std::uint64_t session) {
  return "vat.log." + std::to_string(session);
}
inline std::string chunk_subject(std::uint64_t session) {
  return "vat.checkpoint." + std::to_string(session) + ".chunk";
}
inline std::string manifest_subject(std::uint64_t session) {
  return "vat.checkpoint." + std::to_string(session) + ".manifest";
}

}  // namespace vat
