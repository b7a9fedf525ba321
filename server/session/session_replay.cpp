// A session that shows a recording, and goes to any moment of it.

#include <boost/asio/post.hpp>
#include <utility>

#include "server/session/session.h"

namespace vat {
namespace {

constexpr auto kSeekTurnTime = std::chrono::milliseconds(10);  // so that others get theirs

}  // namespace

void Session::show(std::unique_ptr<ReplayRun> replay) {
  replay_ = std::move(replay);
  replay_->start(core_);
  core_.take_interruption();
  update_summary();
}

void Session::begin_seek(PendingReply caller, std::uint64_t position) {
  end_all_steps();
  if (!seek_) seek_.emplace();
  seek_->callers.push_back(std::move(caller));
  replay_->begin_seek(core_, position);
  if (!std::exchange(seek_scheduled_, true)) schedule(&Session::seek_turn);
}

void Session::seek_turn() {
  seek_scheduled_ = false;
  if (!seek_) return;
  if (replay_->seek_on(core_, CostClock::now() + kSeekTurnTime)) return end_seek();
  seek_scheduled_ = true;
  schedule(&Session::seek_turn);
}

void Session::end_seek() {
  std::vector<PendingReply> callers = std::move(seek_->callers);
  seek_.reset();
  replay_->end_seek(core_);
  core_.take_interruption();
  period_ = {};  // the clock begins anew from here
  update_summary();
  for (PendingReply& caller : callers) {
    caller.answer(Json{{"tick", core_.run().tick()}, {"position", core_.run().position()}});
  }
  if (!steps_.empty()) schedule_step();
}

void Session::keep_and(KeptTask task, const std::shared_ptr<PendingReply>& caller) {
  boost::asio::post(strand_, [self = shared_from_this(), task = std::move(task), caller] {
    SessionLog* const log = self->closed_ ? nullptr : self->core_.log();
    if (log == nullptr) {
      caller->answer(no_such_session(self->id_));
    } else if (self->core_.has_diverged()) {
      caller->answer(not_allowed("the session is not what its log leads to"));
    } else {
      log->keep_and(self->core_.moment(), self->core_.environment().clock.now(), task);
    }
  });
}

}  // namespace vat
