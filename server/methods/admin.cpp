// server.sessions, server.drain, server.move

#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <utility>
#include <variant>

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

constexpr double kMaxDrainSeconds = 3600;

/// Completes the sessions of other nodes by the descriptions of these nodes, and adds the sessions
/// that this node does not know yet.
Json with_descriptions(Json list, std::map<SessionId, Json> descriptions) {
  Json& sessions = list.at("sessions");
  for (Json& session : sessions) {
    auto described = descriptions.extract(session.at("session").get<SessionId>());
    if (described.empty() || session.at("state") != "elsewhere") continue;
    session = std::move(described.mapped());
    session["state"] = "elsewhere";
  }
  for (auto& [id, session] : descriptions) {
    session["state"] = "elsewhere";
    sessions.push_back(std::move(session));
  }
  return list;
}

}  // namespace

ServerAction read_server_sessions(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& reply) -> std::optional<RpcResult> {
    RpcResult list = list_sessions(directory, reply, add_people);
    if (directory.resources().cluster == nullptr) return list;
    directory.describe_elsewhere([list = std::get<Json>(std::move(list)),
                                  waiting = std::make_shared<PendingReply>(std::move(reply))](
                                     const std::map<SessionId, Json>& descriptions) {
      waiting->answer(with_descriptions(list, descriptions));
    });
    return {};
  };
}

ServerAction read_server_drain(ObjectReader& params, Errors&) {
  std::optional<std::chrono::milliseconds> time;
  if (params.has("seconds")) {
    time =
        std::chrono::milliseconds(std::llround(1000 * params.real("seconds", 0, kMaxDrainSeconds)));
  }
  return [time](SessionDirectory& directory, PendingReply&) -> std::optional<RpcResult> {
    return directory.request_drain(time);
  };
}

ServerAction read_server_move(ObjectReader& params, Errors&) {
  const SessionId session = read_session_id(params);
  const std::string node = params.text("node", kMaxNameLength);
  return [session, node](SessionDirectory& directory,
                         PendingReply& reply) -> std::optional<RpcResult> {
    if (auto error = directory.move(reply, session, node)) return *std::move(error);
    return {};
  };
}

}  // namespace vat
