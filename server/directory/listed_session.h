#pragma once

#include <string>

#include "protocol/json/json_reader.h"
#include "server/directory/server_settings.h"
#include "server/session/core/session_summary.h"

namespace vat {

/// Session of a list for a client.
struct ListedSession {
  SessionId id;
  SessionSummary summary;
  /// "running", "recovering", "lost", or "elsewhere" on another node; only the first state has
  /// more than a name.
  const char* state;
  bool is_closable = false;  ///< the client may close the session
  std::string node;          ///< node of the cluster; empty: none, or no cluster
};

/// Returns the members that all lists have.
Json describe_session(const ListedSession& session);
/// Adds the members of server.sessions.
void add_people(Json& session, const SessionSummary& summary);

}  // namespace vat
