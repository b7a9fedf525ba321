#pragma once

#include <cstddef>
#include <optional>
#include <string_view>
#include <variant>

#include "server/directory/session_directory.h"
#include "server/messages/method_row.h"

namespace vat {

/// Reader of client messages. Checks rates, sizes, roles and parameters, and calls the methods.
/// Runs on the transport's threads.
class Dispatcher {
 public:
  explicit Dispatcher(SessionDirectory& directory) : directory_(directory) {}

  /// Executes a message. An error reply contains the id of the message, or null without an id.
  void receive(const SessionDirectory::Sender& sender, std::string_view message);
  /// Refuses a binary message, which only the server may send.
  void receive_binary(ClientOutbox& client, std::size_t bytes);

 private:
  const ServerLimits& limits() const { return directory_.resources().settings.limits; }
  /// Answers a message that exceeds a rate. Closes the connection of a client that continues to
  /// exceed rates. `method` is empty if the message was not read.
  void refuse(ClientOutbox& client, const std::optional<Json>& id, std::string_view method,
              const RateExcess& excess);
  /// Sends a message to the owner of the client's session, if the owner answers it and is another
  /// node. Returns false otherwise.
  bool forward(const SessionDirectory::Sender& sender, const RpcRequest& request,
               const std::optional<Json>& id, std::string_view message);
  std::variant<RpcRequest, RpcError> read(std::string_view message, Role role,
                                          std::optional<Json>& id) const;
  /// Refuses a method that needs memory if the process exceeds its limit.
  std::optional<RpcError> refuse_for_memory(const MethodRow& row) const;
  /// Returns the result, or an empty optional if `reply` was moved and is answered later.
  std::optional<RpcResult> call(PendingReply& reply, const SessionDirectory::Sender& sender,
                                RpcRequest request, std::size_t bytes);
  /// Starts or ends the frames of a session on another node.
  static std::optional<RpcResult> call_frames(PendingReply& reply, RelayedClient& relay,
                                              const RpcRequest& request);

  SessionDirectory& directory_;
};

}  // namespace vat
