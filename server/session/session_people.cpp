// The participants of a session: who comes, goes, and may do what.

#include <spdlog/spdlog.h>

#include <string>
#include <utility>
#include <vector>

#include "server/session/method_table.h"
#include "server/session/session_core.h"

namespace vat {
namespace {

constexpr std::uint16_t kKicked = 4003;
constexpr std::uint16_t kReplaced = 4010;
// Who is away since then is due to leave at any time of a clock that begins with the machine.
constexpr auto kLongAgo = SteadyClock::time_point(-std::chrono::hours(24));

}  // namespace

std::variant<Entry, RpcError> SessionCore::join(const std::shared_ptr<ClientOutbox>& outbox,
                                                std::uint64_t membership,
                                                const JoinRequest& join_request,
                                                SteadyClock::time_point now) {
  Participant* resumed = join_request.resume
                             ? participants_.find_resume(hash_of_token(*join_request.resume))
                             : nullptr;
  const Participant* before = participants_.find_client(outbox->id());
  if (before != nullptr && before != resumed) leave(before->number);
  const bool may_pass = join_request.passes_lock || outbox->id() == settings_.creator;
  if (resumed == nullptr && settings_.is_locked && !may_pass) {
    return not_allowed("the session is locked");
  }
  std::string token = resumed != nullptr ? *join_request.resume : "";
  Participant& participant = resumed != nullptr ? *resumed : take_in(*outbox, join_request, token);
  if (participant.is_here()) release_connection(participant, outbox->id());
  participants_.connect(participant, outbox, membership);
  outbox->start_epoch(membership, run_.epoch());
  divergence_due_ = divergence_.has_value();
  if (participant.subscription) subscribe(participant, *participant.subscription, now);
  status_due_ = true;
  return Entry{participant, std::move(token), resumed != nullptr};
}

Participant& SessionCore::take_in(const ClientOutbox& outbox, const JoinRequest& join_request,
                                  std::string& token) {
  const bool is_creator = outbox.id() == settings_.creator && join_request.role != Role::admin;
  const Role role = is_creator ? Role::owner : join_request.role.value_or(settings_.default_role);
  token = make_token();
  Participant& participant = participants_.add(join_request.name, role);
  if (participant.name.empty()) participant.name = "guest " + std::to_string(participant.number);
  participant.resume = hash_of_token(token);
  environment_->tokens.add(*participant.resume, {Role::viewer, id_});
  return participant;
}

void SessionCore::release_connection(const Participant& participant, ConnectionId next) {
  const std::shared_ptr<ClientOutbox>& outbox = participant.outbox;
  if (participant.subscription) frames_->remove(outbox->id());
  if (outbox->id() != next) outbox->close(kReplaced, "replaced by a resumed connection");
}

void SessionCore::disconnect(ConnectionId client, SteadyClock::time_point now) {
  Participant* participant = participants_.find_client(client);
  if (participant == nullptr) return;
  if (participant->subscription) frames_->remove(client);
  participants_.disconnect(*participant);
  participant->away_since = now;
  status_due_ = true;
  bound_absences();
}

void SessionCore::leave(ParticipantNumber number) {
  Participant* participant = participants_.find(number);
  if (participant == nullptr) return;
  if (participant->is_here() && participant->subscription) {
    frames_->remove(participant->outbox->id());
  }
  if (participant->resume) environment_->tokens.remove(*participant->resume);
  status_due_ = true;
  LogEntry entry = make_entry(number, kLeaveEntry, "{}");
  if (log({&entry, 1})) {
    participants_.disconnect(*participant);
    participant->away_since = kLongAgo;
    participant->resume.reset();
    return;
  }
  carry_out_leave(entry);
}

void SessionCore::carry_out_leave(const LogEntry& entry) {
  carry_out_let_go(entry);
  participants_.remove(entry.participant);
}

void SessionCore::let_go(const Participant& participant) {
  if (participant.grabs.empty()) return;
  LogEntry entry = make_entry(participant.number, kLetGoEntry, "{}");
  if (!log({&entry, 1})) carry_out_let_go(entry);
}

void SessionCore::carry_out_let_go(const LogEntry& entry) {
  sequence_ = entry.sequence;
  const Participant* participant = participants_.find(entry.participant);
  if (participant == nullptr) return;
  const auto grabs = participant->grabs;
  for (const auto& [grab, body] : grabs) {
    const Status ended = run_.simulation().grab_end(grab);
    if (!ended) spdlog::warn("session {}: grab {} was gone already", id_, grab);
    participants_.forget_grab(grab);
  }
}

void SessionCore::kick(ParticipantNumber number, const std::string& reason) {
  const Participant* participant = participants_.find(number);
  if (participant == nullptr) return;
  const std::shared_ptr<ClientOutbox> outbox = participant->outbox;
  leave(number);
  if (outbox != nullptr) outbox->close(kKicked, reason);
}

void SessionCore::rename(Participant& participant, std::string name) {
  participant.name = std::move(name);
  participants_.touch();
}

void SessionCore::set_role(Participant& participant, Role role) {
  if (role == Role::owner) {
    settings_.creator = 0;
    for (const auto& [number, other] : participants_.all()) {
      if (other.role == Role::owner)
        participants_.set_role(*participants_.find(number), Role::controller);
    }
  }
  participants_.set_role(participant, role);
  if (role < Role::controller) let_go(participant);
}

void SessionCore::end_grab(ParticipantNumber participant, std::uint64_t grab) {
  const SessionCommand command = make_command("grab.end", {{"grab", grab}});
  const ParticipantCommand given{participant, command};
  carry_out({&given, 1});
}

void SessionCore::end_idle_grabs(SteadyClock::time_point now) {
  struct Idle {
    ParticipantNumber participant;
    std::uint64_t grab;
    BodyId body;
  };
  std::vector<Idle> idle;
  for (const auto& [number, holder] : participants_.all()) {
    auto& uses = participants_.find(number)->grab_uses;
    for (const auto& [grab, body] : holder.grabs) {
      // One of before a restart was used just now, as far as anybody knows.
      const auto used = uses.try_emplace(grab, now).first->second;
      if (now - used >= environment_->limits.grab_idle) idle.push_back({number, grab, body});
    }
  }
  for (const auto& [number, grab, body] : idle) {
    end_grab(number, grab);
    if (participants_.holder_of(grab) != nullptr) continue;  // it could not be logged: later
    const Json event{{"grab", grab}, {"body", body}, {"participant", number}, {"reason", "idle"}};
    participants_.send_event(write_event("grab.ended", event));
  }
}

void SessionCore::tell_presence(SteadyClock::time_point now) {
  Json changes = presence_.take_changes(participants_, now);
  if (!changes.is_null()) {
    participants_.send_event(write_event("presence.changed", std::move(changes)));
  }
}

void SessionCore::configure(SessionSettings settings) {
  if (log_ != nullptr) log_->configure(settings.name, write_settings(settings).dump());
  settings_ = std::move(settings);
  participants_.send_event(write_event("session.configured", describe_settings()));
}

Json SessionCore::describe_settings() const {
  return {{"name", settings_.name},
          {"default_role", to_string(settings_.default_role)},
          {"locked", settings_.is_locked}};
}

void SessionCore::end_absences(SteadyClock::time_point now) {
  std::vector<ParticipantNumber> gone;
  for (const auto& [number, participant] : participants_.all()) {
    if (participant.role < Role::controller) let_go(participant);  // what could not be logged then
    if (!participant.is_away()) continue;
    if (now - *participant.away_since >= environment_->limits.resume_time) gone.push_back(number);
  }
  for (const ParticipantNumber number : gone) leave(number);
}

void SessionCore::bound_absences() {
  if (participants_.away() <= environment_->limits.max_clients_per_session) return;
  const Participant* first = nullptr;
  for (const auto& [number, participant] : participants_.all()) {
    if (!participant.is_away()) continue;
    if (first == nullptr || participant.away_since < first->away_since) first = &participant;
  }
  leave(first->number);
}

}  // namespace vat
