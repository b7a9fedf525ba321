#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "server/clients/pending_reply.h"
#include "server/relay/relay_end.h"
#include "server/support/clock.h"
#include "server/support/owned_mutex.h"

namespace vat {

/// Request of a client of this node about a session of another node, which the client has not
/// joined. The link ends with the reply. Thread-safe.
class RelayedRequest final : public RelayEnd, public std::enable_shared_from_this<RelayedRequest> {
 public:
  /// Called with the result before the client receives it, and may change it.
  using NoteResult = std::function<void(Json& result)>;
  /// Functions of the node. They must not wait for the client.
  struct Links {
    std::function<void()> note_move;  ///< called if the owner has the session no longer
    NoteResult note_result;           ///< may be empty
  };
  RelayedRequest(RelayPlace place, std::unique_ptr<RelayLine> line, Links links,
                 const Clock& clock);

  /// Opens the link, and sends the request. The request exists until its reply or a failure. Call
  /// it once.
  void send(PendingReply reply, const RelayEntry& entry, std::string_view method,
            const Json& params);

  void receive(RelayMessage message) override;
  /// Answers with an error, because the owner cannot be reached.
  void fail() override;
  /// Has no effect: the node that has received the request answers it, also after a hand-over.
  void owner_changed() override {}
  void look() override;

 private:
  void send_text(std::string text);
  void receive_text(const std::string& text);
  void finish_enter(const Json& message);
  void finish(RpcResult result);
  RpcResult read_result(const Json& message) const;

  const std::unique_ptr<RelayLine> line_;
  const Links links_;
  const Clock& clock_;

  OwnedMutex mutex_;  // guards the members below
  RelayInput received_;
  SteadyClock::time_point heard_;
  SteadyClock::time_point asked_;
  std::function<void(const Grant&)> granted_;  // of the entry
  std::string request_;                        // follows the acceptance of the token
  std::optional<PendingReply> reply_;
  std::shared_ptr<RelayedRequest> keeper_;  // this request, while it waits for its reply
};

}  // namespace vat
