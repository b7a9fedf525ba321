#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <variant>

#include "server/http/downloads.h"
#include "server/nats/nats_connection.h"

namespace vat {

/// Answers other nodes with parts of this node's files, and fetches files of other nodes part by
/// part. Thread-safe.
class RelayDownloads {
 public:
  /// Size of a part. A transfer has at most one part on its way.
  static constexpr std::size_t kPartBytes = std::size_t{512} * 1024;

  /// Listens from now on. The arguments must outlive the object and its transfers.
  RelayDownloads(const std::string& node, NatsConnection& connection, Downloads& downloads,
                 const Clock& clock);

  /// Fetches a file of another node. Calls `answer` once: with the file, with 404 if the node does
  /// not have it, or with 503 if the node does not answer or this node has no room for the file.
  void fetch(const std::string& node, const std::string& path,
             std::function<void(HttpResponse)> answer);

  /// Returns the subject on which a node receives requests for its files.
  static std::string subject_of(const std::string& node);

 private:
  struct Transfer {
    std::string node;
    std::string path;
    Downloads::File file;
    Downloads::Room room;  // null: the size of the file is unknown
    std::function<void(HttpResponse)> answer;
  };
  void send_part(const NatsMessage& request);
  void request_part(const std::shared_ptr<Transfer>& transfer);
  void take_part(const std::shared_ptr<Transfer>& transfer, const std::string& bytes);

  NatsConnection& connection_;
  Downloads& downloads_;
  const Clock& clock_;
  std::unique_ptr<NatsConnection::Subscription> subscription_;
};

}  // namespace vat
