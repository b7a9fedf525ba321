// Work of a session on other threads: reads, recordings and saves.

#include <boost/asio/post.hpp>
#include <memory>
#include <utility>

#include "core/support/check.h"
#include "server/clients/answer_with.h"
#include "server/session/core/command_entry.h"
#include "server/session/session.h"
#include "server/session/session_archive.h"
#include "server/support/stage_clock.h"

namespace vat {

void Session::start_reads() {
  const std::shared_ptr<ReadBatch> batch = reads_.begin_batch(std::as_const(*core_).run());
  if (batch == nullptr) return;
  boost::asio::post(core_->environment().read_threads, [self = weak_from_this(), batch] {
    batch->run();
    if (const auto session = self.lock()) session->schedule(&Session::reads_done_turn);
  });
}

void Session::reads_done_turn() {
  reads_.end_batch();
  start_reads();
}

void Session::post_behind(std::function<void()> task) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task)]() mutable {
    if (self->uses_storage()) return self->tasks_behind_storage_.push_back(std::move(task));
    self->run_behind_storage(std::move(task));
  });
}

void Session::run_behind_storage(std::function<void()> task) {
  boost::asio::post(storage_strand_, [self = shared_from_this(), task = std::move(task)]() mutable {
    self->core_->notifier().post_behind_frames(std::move(task));
  });
}

void Session::store_then(StoredTask task, const std::shared_ptr<PendingReply>& reply) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task), reply] {
    SessionHistory& history = self->core_->history();
    SessionLog* const log = self->closed_ ? nullptr : history.log();
    if (log == nullptr) {
      reply->answer(no_such_session(self->id()));
    } else if (history.divergence()) {
      reply->answer(not_allowed("the session differs from its log"));
    } else {
      log->store_then(history.moment(), self->clock_.now(), task);
    }
  });
}

void Session::export_recording(PendingReply reply) {
  const auto pending = std::make_shared<PendingReply>(std::move(reply));
  if (core_->environment().downloads == nullptr) {
    pending->answer(not_allowed("this server offers no downloads"));
    return;
  }
  // Not on the storage's own thread, which has other sessions to store.
  const auto make = [self = shared_from_this(), pending](Storage& storage, std::uint64_t number) {
    boost::asio::post(self->storage_strand_, [self, pending, &storage, number] {
      answer_with(*pending, "session " + self->id() + ": no recording", [&] {
        return vat::export_recording(self->core_->environment(), self->id(), storage, number,
                                     self->summary().tick);
      });
    });
  };
  SessionHistory& history = core_->history();
  VAT_CHECK(history.log() != nullptr);
  history.log()->store_then(history.moment(), clock_.now(), make);
}

void Session::use_storage(PendingReply reply, const SessionCommand& command, StorageWork work) {
  const bool is_read = command.row->rate_class == RateClass::read;
  if (is_read && reads_.refuse_excess(reply)) return;
  const auto pending = std::make_shared<PendingReply>(std::move(reply));
  boost::asio::post(storage_strand_, [self = shared_from_this(), pending, is_read,
                                      name = command.row->name, tick = core_->run().tick(),
                                      budget = reads_.budget(), work = std::move(work.work)] {
    answer_with(*pending, "session " + self->id() + ": " + std::string(name), [&] {
      const auto begin = thread_time();
      RpcResult result = work();
      auto* const content = std::get_if<Json>(&result);
      if (content == nullptr) return result;
      content->emplace("tick", tick);
      if (is_read) {
        charge_read(*budget, *pending->client(), content->dump().size(), thread_time() - begin,
                    self->clock_.now());
      }
      return result;
    });
  });
}

void Session::invite(PendingReply reply, const IssueInvitation& wanted) {
  const SessionEnvironment& environment = core_->environment();
  environment.tokens.issue(
      {wanted.role, id(), true}, wanted.uses, wanted.time,
      [wanted, tick = core_->run().tick(), maximum = environment.limits.max_tokens,
       pending =
           std::make_shared<PendingReply>(std::move(reply))](const AccessTokens::Issued& issued) {
        if (issued.failure) return pending->answer(storage_failed(*issued.failure));
        if (!issued.token) return pending->answer(limit_reached("tokens", maximum));
        pending->answer(Json{{"token", *issued.token},
                             {"role", to_string(wanted.role)},
                             {"expires", wanted.time.count()},
                             {"tick", tick}});
      });
}

void Session::resolve_then(SessionCommand command, std::function<void(SessionCommand)> then) {
  const auto resolved = std::make_shared<SessionCommand>(std::move(command));
  wait_then(
      [self = shared_from_this(), resolved](Journal::Done done) {
        boost::asio::post(self->storage_strand_, [self, resolved, done = std::move(done)] {
          resolved->resolution = std::make_shared<const CommandResolution>(
              resolve_command(self->core_->environment(), self->id(), *resolved));
          done({});
        });
      },
      [resolved, then = std::move(then)](auto) { then(std::move(*resolved)); });
}

}  // namespace vat
