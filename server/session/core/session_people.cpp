#include "server/session/core/session_people.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::uint16_t kKicked = 4003;
constexpr std::uint16_t kReplaced = 4010;
// Before every time of the steady clock minus the resume time.
constexpr auto kLongAgo = SteadyClock::time_point(-std::chrono::hours(24));

}  // namespace

SessionPeople::SessionPeople(SessionContext& context, SessionRun& run, Participants& participants,
                             SessionHistory& history, SessionNotifier& notifier)
    : context_(context),
      run_(run),
      participants_(participants),
      history_(history),
      notifier_(notifier) {}

std::variant<JoinedParticipant, RpcError> SessionPeople::join(
    const std::shared_ptr<ClientOutbox>& outbox, std::uint64_t membership,
    const JoinRequest& request, SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  Participant* resumed =
      request.resume ? participants_.find_resume(hash_of_token(*request.resume)) : nullptr;
  const Participant* before = participants_.find_client(outbox->id());
  if (before != nullptr && before != resumed) leave(before->number);
  const bool may_pass = request.passes_lock || outbox->id() == context_.settings.creator;
  if (resumed == nullptr && context_.settings.is_locked && !may_pass) {
    return not_allowed("the session is locked");
  }
  std::string token = resumed != nullptr ? *request.resume : "";
  Participant& participant = resumed != nullptr ? *resumed : add(*outbox, request, token);
  if (participant.is_here()) release_connection(participant, outbox->id());
  participants_.connect(participant, outbox, membership);
  outbox->start_epoch(membership, run_.epoch());
  if (history_.divergence()) notifier_.mark_divergence();
  if (participant.subscription) notifier_.subscribe(participant, *participant.subscription, now);
  notifier_.mark_status();
  return JoinedParticipant{participant, std::move(token), resumed != nullptr};
}

Participant& SessionPeople::add(const ClientOutbox& outbox, const JoinRequest& request,
                                std::string& token) {
  const bool is_creator = outbox.id() == context_.settings.creator && request.role != Role::admin;
  const Role granted =
      is_creator ? Role::owner : request.role.value_or(context_.settings.default_role);
  const Role role = std::min(granted, request.greatest_role.value_or(granted));
  token = context_.environment->tokens.make_resume(context_.id);
  Participant& participant = participants_.add(request.name, role);
  if (participant.name.empty()) participant.name = "guest " + std::to_string(participant.number);
  participant.resume = hash_of_token(token);
  context_.environment->tokens.add(*participant.resume, {Role::viewer, context_.id});
  return participant;
}

void SessionPeople::release_connection(const Participant& participant, ConnectionId next) {
  const std::shared_ptr<ClientOutbox>& outbox = participant.outbox;
  if (participant.subscription) notifier_.remove_viewer(outbox->id());
  if (outbox->id() != next) outbox->close(kReplaced, "replaced by a resumed connection");
}

void SessionPeople::disconnect(ConnectionId client, SteadyClock::time_point now) {
  VAT_CHECK(context_.owner.allows_this_thread());
  Participant* participant = participants_.find_client(client);
  if (participant == nullptr) return;
  if (participant->subscription) notifier_.remove_viewer(client);
  participants_.disconnect(*participant);
  participant->away_since = now;
  notifier_.mark_status();
  bound_absences();
}

void SessionPeople::leave(ParticipantNumber number) {
  VAT_CHECK(context_.owner.allows_this_thread());
  Participant* participant = participants_.find(number);
  if (participant == nullptr) return;
  if (participant->is_here() && participant->subscription) {
    notifier_.remove_viewer(participant->outbox->id());
  }
  if (participant->resume) context_.environment->tokens.remove(*participant->resume);
  participants_.disconnect(*participant);
  participant->away_since = kLongAgo;
  participant->resume.reset();
  notifier_.mark_status();
}

std::vector<LogEntry> SessionPeople::due_entries(SteadyClock::time_point now) const {
  VAT_CHECK(context_.owner.allows_this_thread());
  std::vector<LogEntry> entries;
  for (const auto& [number, participant] : participants_.all()) {
    const bool is_gone = participant.is_away() &&
                         now - *participant.away_since >= context_.environment->limits.resume_time;
    if (is_gone) {
      entries.push_back(history_.make_entry(number, kLeaveEntry, "{}"));
    } else if (participant.role < Role::controller && !participant.grabs.empty()) {
      entries.push_back(history_.make_entry(number, kReleaseGrabsEntry, "{}"));
    }
  }
  return entries;
}

void SessionPeople::execute(std::span<const LogEntry> entries) {
  for (const LogEntry& entry : entries) {
    const bool is_departure = entry.method == kLeaveEntry;
    VAT_CHECK(is_departure || entry.method == kReleaseGrabsEntry);
    if (is_departure) {
      execute_leave(entry);
    } else {
      execute_release(entry);
    }
  }
  notifier_.mark_status();
}

void SessionPeople::execute_leave(const LogEntry& entry) {
  execute_release(entry);
  participants_.remove(entry.participant);
}

void SessionPeople::execute_release(const LogEntry& entry) {
  history_.execute(entry);
  const Participant* participant = participants_.find(entry.participant);
  if (participant == nullptr) return;
  const auto grabs = participant->grabs;
  for (const auto& [grab, body] : grabs) {
    const Status ended = run_.simulation().grab_end(grab);
    if (!ended) log_warning("session {}: grab {} had already ended", context_.id, grab);
    participants_.forget_grab(grab);
  }
}

void SessionPeople::kick(ParticipantNumber number, const std::string& reason) {
  const Participant* participant = participants_.find(number);
  if (participant == nullptr) return;
  const std::shared_ptr<ClientOutbox> outbox = participant->outbox;
  leave(number);
  if (outbox != nullptr) outbox->close(kKicked, reason);
}

void SessionPeople::rename(Participant& participant, std::string name) {
  participant.name = std::move(name);
  participants_.touch();
}

void SessionPeople::set_role(Participant& participant, Role role) {
  VAT_CHECK(role > Role::none);
  if (role == Role::owner) {
    context_.settings.creator = 0;
    for (const auto& [number, other] : participants_.all()) {
      if (other.role == Role::owner)
        participants_.set_role(*participants_.find(number), Role::controller);
    }
  }
  participants_.set_role(participant, role);
}

void SessionPeople::configure(SessionSettings settings) {
  context_.settings = std::move(settings);
  participants_.send_event(write_event("session.configured", describe_settings()));
  notifier_.mark_status();
}

Json SessionPeople::describe_settings() const {
  const SessionSettings& settings = context_.settings;
  Json described{{"name", settings.name},
                 {"default_role", to_string(settings.default_role)},
                 {"locked", settings.is_locked}};
  const std::span<const GovernorPoint> points = history_.governor_points();
  if (!points.empty()) described["governor"] = write_governor_points(points);
  return described;
}

void SessionPeople::bound_absences() {
  if (participants_.away() <= context_.environment->limits.max_clients_per_session) return;
  const Participant* first = nullptr;
  for (const auto& [number, participant] : participants_.all()) {
    if (!participant.is_away()) continue;
    if (first == nullptr || participant.away_since < first->away_since) first = &participant;
  }
  VAT_CHECK(first != nullptr);
  leave(first->number);
}

void SessionPeople::recover(SteadyClock::time_point now) {
  std::vector<ParticipantNumber> without_token;  // joined after the last stored participants
  for (const auto& [number, participant] : participants_.all()) {
    if (participant.resume) {
      context_.environment->tokens.add(*participant.resume, {Role::viewer, context_.id});
    } else {
      without_token.push_back(number);
    }
  }
  participants_.send_away(now);
  for (const ParticipantNumber number : without_token) leave(number);
}

}  // namespace vat
