// server.sessions, server.drain, server.move

#include <chrono>
#include <cmath>

#include "core/limits.h"
#include "server/methods/handlers.h"
#include "server/methods/parts.h"

namespace vat {
namespace {

constexpr double kMaxDrainSeconds = 3600;

Json describe_people(const SessionSummary& summary) {
  Json people = Json::array();
  if (summary.people == nullptr) return people;
  for (const PersonSummary& person : *summary.people) {
    Json one{{"participant", person.number},
             {"name", person.name},
             {"role", to_string(person.role)},
             {"away", person.address.empty()}};
    if (!person.address.empty()) one["address"] = person.address;
    people.push_back(std::move(one));
  }
  return people;
}

void add_people(Json& session, const SessionSummary& summary) {
  session["hibernating"] = summary.hibernating;
  session["participants"] = describe_people(summary);
}

}  // namespace

ServerAction read_server_sessions(ObjectReader&, Errors&) {
  return [](SessionDirectory& directory, PendingReply& reply) {
    return list_sessions(directory, reply, add_people);
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
