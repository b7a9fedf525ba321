#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace vat {

/// Settings of a server that is a node of a cluster.
struct ClusterSettings {
  std::vector<std::string> servers;  ///< URLs of the NATS servers; empty: no cluster
  std::string node;                  ///< name of the node, unique in the cluster
  std::string public_url;            ///< URL at which clients reach the node
  std::string route = "redirect";    ///< of clients of other nodes' sessions; or "relay"
  std::string tls_ca;                ///< see NatsSettings
  std::string tls_certificate;
  std::string tls_key;
  std::string credentials;
  std::string key_file;  ///< file with `key`; empty: a variable of the environment has it
  std::string key;       ///< key for signed tokens; empty: tokens are not signed
  /// Time for which NATS keeps the node's entry. The default is that of the lease.
  std::optional<std::chrono::milliseconds> entry_life;
  /// Greatest time until other nodes answer. The default is that of their next renewal.
  std::optional<std::chrono::milliseconds> answer_time;

  bool is_used() const { return !servers.empty(); }
  bool is_relay() const { return route == "relay"; }
};

}  // namespace vat
