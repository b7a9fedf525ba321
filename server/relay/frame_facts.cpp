#include "server/relay/frame_facts.h"

namespace vat {
namespace {

Json to_list(const Vec3& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Vec3 read_list(const Json& list) {
  return Vec3(list.at(0).get<Real>(), list.at(1).get<Real>(), list.at(2).get<Real>());
}

}  // namespace

Json write_frame_facts(const FrameFacts& facts) {
  Json json{{"default_error", facts.default_error}};
  if (!facts.vat) return json;
  json["vat"] = {{"min", to_list(facts.vat->min)}, {"max", to_list(facts.vat->max)}};
  if (facts.vat->motion) {
    json["vat"]["axis"] = to_list(facts.vat->motion->axis);
    json["vat"]["stroke"] = facts.vat->motion->stroke;
  }
  return json;
}

FrameFacts read_frame_facts(const Json& json) {
  FrameFacts facts{{}, json.at("default_error").get<double>()};
  const auto vat = json.find("vat");
  if (vat == json.end()) return facts;
  facts.vat.emplace();
  facts.vat->min = read_list(vat->at("min"));
  facts.vat->max = read_list(vat->at("max"));
  if (vat->contains("axis")) {
    facts.vat->motion = SlideMotion{read_list(vat->at("axis")), vat->at("stroke").get<Real>(), 1};
  }
  return facts;
}

}  // namespace vat
