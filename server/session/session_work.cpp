// Work of a session on other threads: reads, recordings and saves.

#include <boost/asio/post.hpp>
#include <memory>
#include <utility>

#include "core/support/check.h"
#include "server/clients/answer_with.h"
#include "server/session/session.h"
#include "server/session/session_archive.h"

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
  // On the pool: the storage's thread has other sessions to store.
  const auto make = [self = shared_from_this(), pending](Storage& storage, std::uint64_t number) {
    boost::asio::post(self->strand_.get_inner_executor(), [self, pending, &storage, number] {
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

void Session::save(PendingReply reply, SaveState save) {
  // On the pool: the session continues meanwhile.
  const auto pending = std::make_shared<PendingReply>(std::move(reply));
  boost::asio::post(strand_.get_inner_executor(),
                    [self = shared_from_this(), pending, save = std::move(save),
                     moment = moment_to_save(*core_), &environment = core_->environment()] {
                      answer_with(*pending, "session " + self->id() + ": not saved", [&] {
                        return save_state(environment, self->id(), moment, save);
                      });
                    });
}

}  // namespace vat
