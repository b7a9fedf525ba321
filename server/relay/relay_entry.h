#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

#include "server/access/access.h"
#include "server/messages/rpc_message.h"
#include "server/relay/relay_message.h"

namespace vat {

/// Place of a link to the owner of a session.
struct RelayPlace {
  std::string session;
  std::string owner;        ///< name of the node
  std::uint64_t epoch = 0;  ///< of the owner
  std::string own_url;      ///< URL of this node
  std::string subject;      ///< subject of the messages to this node's clients
};

/// Access of a client that a relay shows to the owner of a session.
struct RelayEntry {
  Grant access;
  bool is_open = false;  ///< this node requires no token
  /// Token that the client shows to the owner first; empty: none.
  std::string token;
  /// Called with the access that the owner grants for the token.
  std::function<void(const Grant&)> granted;
};

/// Id of the request in which a relay shows a token to the owner.
inline constexpr const char* kEnterId = "vat.enter";

/// Opens a link for a client with this address, and shows its token. Returns false if there is no
/// connection.
bool send_entry(RelayLine& line, const RelayPlace& place, const std::string& address,
                const RelayEntry& entry);
/// Returns the text of the request that shows a token.
std::string write_enter(const std::string& token);
/// Returns the text of a request to the owner.
std::string write_owner_request(const char* id, std::string_view method, const Json& params);

// The functions below read replies of another node, and throw Json::exception if a member is
// missing.

/// Returns the error with the kind of the reply's error.
RpcError read_owner_error(const Json& error);
/// Returns the role with this name, or Role::none.
Role read_owner_role(const Json& name);
/// Returns the access in a result of access.enter.
Grant read_granted(const Json& result);

}  // namespace vat
