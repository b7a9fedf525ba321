#include "server/session/method_rules.h"

#include <algorithm>
#include <stdexcept>
#include <string>

namespace vat {
namespace {

constexpr bool kLogged = true;
constexpr bool kNotLogged = false;
constexpr bool kOfNamedSession = true;

constexpr MethodRules kRules[] = {
    {"server.info", Role::none, MessageClass::query, kNotLogged},
    {"scene.list", Role::viewer, MessageClass::query, kNotLogged},
    {"scene.get", Role::viewer, MessageClass::scene, kNotLogged},
    {"session.create", Role::controller, MessageClass::scene, kNotLogged},
    {"session.list", Role::viewer, MessageClass::query, kNotLogged},
    {"session.join", Role::viewer, MessageClass::control, kNotLogged},
    {"session.leave", Role::viewer, MessageClass::control, kNotLogged},
    {"session.close", Role::owner, MessageClass::control, kNotLogged, kOfNamedSession},
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
    {"world.move_body", Role::controller, MessageClass::pointer, kLogged},
    {"world.set_material", Role::controller, MessageClass::control, kLogged},
    {"world.set_numerics", Role::controller, MessageClass::control, kLogged},
    {"world.move_vat", Role::controller, MessageClass::pointer, kLogged},
    {"grab.start", Role::controller, MessageClass::control, kLogged},
    {"grab.move", Role::controller, MessageClass::pointer, kLogged},
    {"grab.end", Role::controller, MessageClass::control, kLogged},
    {"frames.subscribe", Role::viewer, MessageClass::control, kNotLogged},
    {"frames.unsubscribe", Role::viewer, MessageClass::control, kNotLogged},
    {"frames.ack", Role::viewer, MessageClass::query, kNotLogged},
    {"state.query", Role::viewer, MessageClass::query, kNotLogged},
    {"state.connections", Role::viewer, MessageClass::query, kNotLogged},
    {"session.hash", Role::viewer, MessageClass::query, kNotLogged},
    {"session.stats", Role::viewer, MessageClass::query, kNotLogged},
    {"session.configure", Role::owner, MessageClass::control, kNotLogged},
    {"session.invite", Role::owner, MessageClass::control, kNotLogged},
    {"participant.rename", Role::viewer, MessageClass::control, kNotLogged},
    {"participant.set_role", Role::owner, MessageClass::control, kNotLogged},
    {"participant.kick", Role::owner, MessageClass::control, kNotLogged},
    {"control.request", Role::viewer, MessageClass::control, kNotLogged},
    {"control.hand_over", Role::controller, MessageClass::control, kNotLogged},
    {"presence.list", Role::viewer, MessageClass::query, kNotLogged},
    {"presence.point", Role::viewer, MessageClass::pointer, kNotLogged},
    {"access.enter", Role::none, MessageClass::control, kNotLogged},
    {"access.ticket", Role::owner, MessageClass::control, kNotLogged, kOfNamedSession},
    {"recording.export", Role::controller, MessageClass::scene, kNotLogged},
    {"recording.import", Role::controller, MessageClass::scene, kNotLogged},
    {"replay.open", Role::controller, MessageClass::scene, kNotLogged, kOfNamedSession},
    {"replay.info", Role::viewer, MessageClass::query, kNotLogged},
    {"replay.seek", Role::controller, MessageClass::control, kNotLogged},
    {"session.save", Role::controller, MessageClass::scene, kNotLogged},
    {"session.load", Role::controller, MessageClass::scene, kLogged},
    {"session.saves", Role::viewer, MessageClass::query, kNotLogged},
    {"session.delete_save", Role::controller, MessageClass::control, kNotLogged},
    {"scene.save", Role::controller, MessageClass::scene, kNotLogged},
    {"scene.delete", Role::controller, MessageClass::control, kNotLogged},
    {"server.sessions", Role::admin, MessageClass::query, kNotLogged},
    {"server.drain", Role::admin, MessageClass::control, kNotLogged},
};

}  // namespace

std::span<const MethodRules> method_rules() {
  return kRules;
}

const MethodRules& rules_of(std::string_view method) {
  const auto found = std::ranges::find(kRules, method, &MethodRules::method);
  if (found == std::end(kRules)) {
    throw std::logic_error("no rules for the method " + std::string(method));
  }
  return *found;
}

bool is_of_clock(std::string_view method) {
  return method == "control.play" || method == "control.pause" || method == "control.step" ||
         method == "control.set_speed";
}

std::optional<RpcError> refuse_role(const MethodRules& rules, Role role) {
  if (role >= rules.least_role) return {};
  if (role == Role::none) return not_authenticated("the first message has to be access.enter");
  return role_too_low(rules.method, role, rules.least_role);
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
