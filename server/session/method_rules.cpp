#include "server/session/method_rules.h"

namespace vat {
namespace {

constexpr bool kLogged = true;
constexpr bool kNotLogged = false;

constexpr MethodRules kRules[] = {
    {"server.info", Role::none, MessageClass::query, kNotLogged},
    {"scene.list", Role::none, MessageClass::query, kNotLogged},
    {"session.create", Role::none, MessageClass::scene, kNotLogged},
    {"session.list", Role::none, MessageClass::query, kNotLogged},
    {"session.join", Role::none, MessageClass::control, kNotLogged},
    {"session.leave", Role::viewer, MessageClass::control, kNotLogged},
    {"session.close", Role::none, MessageClass::control, kNotLogged},
    {"scene.load", Role::controller, MessageClass::scene, kLogged},
    {"control.play", Role::controller, MessageClass::control, kLogged},
    {"control.pause", Role::controller, MessageClass::control, kLogged},
    {"control.step", Role::controller, MessageClass::control, kLogged},
    {"control.reset", Role::controller, MessageClass::control, kLogged},
    {"control.set_speed", Role::controller, MessageClass::control, kLogged},
    {"world.add_body", Role::controller, MessageClass::scene, kLogged},
    {"world.remove_body", Role::controller, MessageClass::control, kLogged},
    {"world.melt_body", Role::controller, MessageClass::control, kLogged},
    {"world.set_emitter", Role::controller, MessageClass::control, kLogged},
    {"world.set_gravity", Role::controller, MessageClass::pointer, kLogged},
    {"world.set_interface", Role::controller, MessageClass::control, kLogged},
    {"world.apply_force", Role::controller, MessageClass::control, kLogged},
    {"grab.start", Role::controller, MessageClass::control, kLogged},
    {"grab.move", Role::controller, MessageClass::pointer, kLogged},
    {"grab.end", Role::controller, MessageClass::control, kLogged},
    {"frames.subscribe", Role::viewer, MessageClass::control, kNotLogged},
    {"frames.unsubscribe", Role::viewer, MessageClass::control, kNotLogged},
    {"frames.ack", Role::none, MessageClass::query, kNotLogged},
    {"state.query", Role::viewer, MessageClass::query, kNotLogged},
    {"session.hash", Role::viewer, MessageClass::query, kNotLogged},
    {"session.stats", Role::viewer, MessageClass::query, kNotLogged},
};

}  // namespace

std::span<const MethodRules> method_rules() {
  return kRules;
}

const char* to_string(MessageClass message_class) {
  switch (message_class) {
    case MessageClass::query:
      return "query";
    case MessageClass::control:
      return "control";
    case MessageClass::pointer:
      return "pointer";
    case MessageClass::scene:
      return "scene";
  }
  return "";
}

}  // namespace vat
