// session.configure, session.invite, participant.*, control.request, control.hand_over

#include <algorithm>
#include <chrono>

#include "core/validation/validate.h"
#include "server/methods/handlers.h"
#include "server/people/person_name.h"

namespace vat {
namespace {

constexpr std::size_t kMaxKickReasonBytes = 100;  // a close frame has at most 123
constexpr std::size_t kMaxUses = 10'000;
constexpr std::uint64_t kMaxExpirySeconds = 30 * 24 * 3600;
constexpr std::uint64_t kUsualExpirySeconds = 24 * 3600;

constexpr Role kGrantableRoles[] = {Role::viewer, Role::controller, Role::owner};

ParticipantNumber read_participant(ObjectReader& params) {
  return params.count("participant", 1, kMaxExactCount);
}

RpcError no_such_participant() {
  return invalid_params(
      {Error{"no_such_participant", "/participant", "must be a participant of this session"}});
}

/// Returns the participant to change. Only an admin may change an admin.
std::variant<Participant*, RpcError> find_other(SessionCore& core, const Participant& caller,
                                                ParticipantNumber number) {
  Participant* other = core.participants().find(number);
  if (other == nullptr) return no_such_participant();
  if (other->role > Role::owner && caller.role <= Role::owner) {
    return not_allowed("only an admin can change an admin");
  }
  return other;
}

/// Returns the errors of points among which the session's governor would choose.
Errors find_governor_errors(const SessionCore& core, std::span<const GovernorPoint> points) {
  Errors errors;
  if (points.empty()) return errors;
  const Scene& present = core.run().simulation().scene();
  if (!find_point(points, present)) {
    return {Error{"not_allowed", "/governor", "must contain the present numerics of the session"}};
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::string path = pointer_to("/governor", i);
    const Scene changed = with_change(present, points[i].numerics);
    for (const Error& error : find_numerics_errors(changed)) {
      add_error(errors, error.code, path + error.path, error.message);
    }
    if (find_point(points, changed) != i) {
      add_error(errors, "repeated", path, "must differ from the numerics of previous points");
    }
    if (!present.emitters.empty() && changed.numerics.step != present.numerics.step) {
      add_error(errors, "not_allowed", path + "/step",
                "must be the present step, because the emitters of the scene depend on it");
    }
  }
  return errors;
}

}  // namespace

SessionAction read_session_configure(ObjectReader& params, Errors& errors) {
  std::optional<std::string> name;
  std::optional<Role> role;
  std::optional<bool> is_locked;
  if (params.has("name")) name = read_person_name(params, "name", errors);
  if (params.has("default_role"))
    role = kGrantableRoles[params.choice("default_role", {"viewer", "controller"})];
  if (params.has("locked")) is_locked = params.boolean("locked");
  std::optional<std::vector<GovernorPoint>> points;
  if (params.has("governor")) points = read_governor_points(params, "governor", errors);
  return [=](SessionCore& core, Participant&) -> ActionResult {
    SessionSettings settings = core.people().settings();
    if (points) {
      if (core.playback() != nullptr) return not_allowed("a replay has no governor");
      if (Errors wrong = find_governor_errors(core, *points); !wrong.empty()) return refused(wrong);
      settings.governor = {core.history().scene_sequence(), *points};
    }
    if (name) settings.name = *name;
    if (role) settings.default_role = *role;
    if (is_locked) settings.is_locked = *is_locked;
    return StoreSettings{std::move(settings)};
  };
}

SessionAction read_session_invite(ObjectReader& params, Errors&) {
  const Role role = kGrantableRoles[params.choice("role", {"viewer", "controller"})];
  std::optional<std::size_t> uses;
  if (params.has("uses")) uses = params.count("uses", 1, kMaxUses);
  const std::uint64_t seconds = params.count("expires", 1, kMaxExpirySeconds, kUsualExpirySeconds);
  return [=](SessionCore&, Participant&) -> ActionResult {
    return IssueInvitation{role, uses, std::chrono::seconds(seconds)};
  };
}

SessionAction read_participant_rename(ObjectReader& params, Errors& errors) {
  const std::string name = read_person_name(params, "name", errors);
  return [name](SessionCore& core, Participant& participant) -> ActionResult {
    core.people().rename(participant, name);
    return Json::object();
  };
}

SessionAction read_participant_set_role(ObjectReader& params, Errors&) {
  const ParticipantNumber number = read_participant(params);
  const Role role = kGrantableRoles[params.choice("role", {"viewer", "controller", "owner"})];
  return [number, role](SessionCore& core, Participant& caller) -> ActionResult {
    const auto other = find_other(core, caller, number);
    if (const auto* error = std::get_if<RpcError>(&other)) return *error;
    if (std::get<Participant*>(other) == &caller) {
      return not_allowed("to give up ownership, make another participant the owner");
    }
    core.people().set_role(*std::get<Participant*>(other), role);
    return Json::object();
  };
}

SessionAction read_participant_kick(ObjectReader& params, Errors&) {
  const ParticipantNumber number = read_participant(params);
  const std::string reason = params.text("reason", kMaxKickReasonBytes, "kicked by the owner");
  return [number, reason](SessionCore& core, Participant& caller) -> ActionResult {
    const auto other = find_other(core, caller, number);
    if (const auto* error = std::get_if<RpcError>(&other)) return *error;
    if (std::get<Participant*>(other) == &caller) {
      return not_allowed("to leave, call session.leave");
    }
    core.people().kick(number, reason);
    return Json::object();
  };
}

SessionAction read_control_request(ObjectReader&, Errors&) {
  return [](SessionCore& core, Participant& participant) -> ActionResult {
    if (participant.role >= Role::controller)
      return not_allowed("the participant has control already");
    const Json params{{"participant", participant.number}, {"name", participant.name}};
    core.participants().send_event(write_event("control.requested", params), Role::controller);
    return Json::object();
  };
}

SessionAction read_control_hand_over(ObjectReader& params, Errors&) {
  const ParticipantNumber number = read_participant(params);
  return [number](SessionCore& core, Participant& caller) -> ActionResult {
    Participant* other = core.participants().find(number);
    if (other == nullptr) return no_such_participant();
    if (other->role != Role::viewer) return not_allowed("the participant has control already");
    core.people().set_role(*other, Role::controller);
    if (caller.role == Role::controller) core.people().set_role(caller, Role::viewer);
    return Json::object();
  };
}

}  // namespace vat
