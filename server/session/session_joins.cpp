// Joins and departures of participants and relays.

#include <memory>
#include <utility>

#include "core/support/check.h"
#include "server/session/session.h"

namespace vat {

void Session::execute_join(PendingReply reply, const SessionInbox::Join& join) {
  auto joined = core_->people().join(reply.client(), join.membership, join.request, clock_.now());
  if (auto* error = std::get_if<RpcError>(&joined)) {
    join.undo();
    reply.answer(std::move(*error));
    return;
  }
  const auto& result = std::get<JoinedParticipant>(joined);
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  // First, because the connection may have been another participant's.
  end_departures([this, waiting, number = result.participant.number, resume = result.resume,
                  resumed = result.resumed, undo = join.undo] {
    store_people_then([this, waiting, number, resume, resumed, undo](const Failure& failure) {
      if (failure) {
        undo();  // the participant stays absent until its time to resume ends
        core_->people().disconnect(waiting->client()->id(), clock_.now());
        return waiting->answer(*failure);
      }
      answer_join(*waiting, number, resume, resumed);
    });
  });
}

void Session::watch(std::shared_ptr<ClientOutbox> viewer, const Subscription& wanted) {
  add({PendingReply(std::move(viewer), {}), SessionInbox::Watch{wanted}});
}

void Session::unwatch(std::shared_ptr<ClientOutbox> viewer) {
  add({PendingReply(std::move(viewer), {}), SessionInbox::Unwatch{}});
}

void Session::store_people_then(std::function<void(const Failure&)> then) {
  SessionLog* const log = core_->history().log();
  if (log == nullptr || !log->is_replicated()) return then({});
  write_then([moment = core_->history().moment()](
                 SessionLog& to, Journal::Done done) { to.store_people(moment, std::move(done)); },
             std::move(then));
}

void Session::answer_join(PendingReply& reply, ParticipantNumber number, const std::string& resume,
                          bool resumed) {
  update_summary();  // before the answer, as below: lists then show what was done
  const Participant* participant = core_->participants().find(number);
  VAT_CHECK(participant != nullptr);
  const Json content{{"tick", core_->run().tick()},
                     {"session", id()},
                     {"participant", number},
                     {"name", participant->name},
                     {"role", to_string(participant->role)},
                     {"resume", resume},
                     {"resumed", resumed},
                     {"settings", core_->people().describe_settings()},
                     {"participants", describe_participants(core_->participants())}};
  const auto description = core_->notifier().description();
  reply.answer_text(begin_object(content, "description") + description.begin, description.end);
}

void Session::execute_leave(PendingReply reply) {
  const ConnectionId client = reply.client()->id();
  if (const Participant* participant = core_->participants().find_client(client)) {
    core_->people().leave(participant->number);
  }
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  end_departures([this, waiting] {
    update_summary();
    waiting->answer(Json{{"tick", core_->run().tick()}});
  });
}

void Session::execute_disconnect(const PendingReply& reply) {
  core_->people().disconnect(reply.client()->id(), clock_.now());
  end_departures([] {});
}

void Session::end_departures(const std::function<void()>& then) {
  std::vector<LogEntry> due = core_->people().due_entries(clock_.now());
  if (due.empty()) return then();
  log_then(std::move(due), [this, then](std::span<const LogEntry> entries, const Failure& failure) {
    // After a failure, the departures stay due.
    if (!failure) core_->people().execute(entries);
    then();
  });
}

}  // namespace vat
