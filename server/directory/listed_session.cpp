#include "server/directory/listed_session.h"

namespace vat {
namespace {

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

}  // namespace

Json describe_session(const ListedSession& session) {
  const SessionSummary& summary = session.summary;
  Json json{{"session", session.id},          {"name", summary.name},
            {"state", session.state},         {"kind", summary.is_replay ? "replay" : "live"},
            {"scene", summary.scene},         {"playing", summary.playing},
            {"tick", summary.tick},           {"particles", summary.particles},
            {"closable", session.is_closable}};
  if (!session.node.empty()) json["node"] = session.node;
  return json;
}

void add_people(Json& session, const SessionSummary& summary) {
  session["hibernating"] = summary.hibernating;
  session["participants"] = describe_people(summary);
}

}  // namespace vat
