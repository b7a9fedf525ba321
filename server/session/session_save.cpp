// How a session's state is kept: for its log, and under a name.

#include <spdlog/spdlog.h>

#include <boost/asio/post.hpp>
#include <exception>
#include <memory>
#include <utility>

#include "server/session/describe.h"
#include "server/session/saved_state.h"
#include "server/session/session.h"

namespace vat {
namespace {

RpcResult save_moment(const SessionEnvironment& environment, const std::string& id,
                      const MomentToSave& moment, const SaveState& save) {
  const SavedState state =
      make_saved_state(moment, save.name, save.saved_by, environment.clock.wall_time());
  const ServerLimits& limits = environment.limits;
  const auto excess =
      environment.states->write(id, state,
                                {limits.max_states_per_session, limits.max_state_bytes_per_session,
                                 limits.max_state_bytes_in_all});
  if (excess) return limit_reached(excess->limit, excess->maximum);
  return Json{{"tick", moment.tick},
              {"name", save.name},
              {"hash", describe_hash(state.entry.hash)},
              {"bytes", state.entry.bytes}};
}

}  // namespace

void Session::keep_moment() {
  SessionLog* log = core_.log();
  const auto now = core_.environment().clock.now();
  if (log != nullptr && log->is_due(core_.run().position(), core_.participants().changes(), now)) {
    log->keep(core_.moment(), now);
  }
}

void Session::end_log(End end) {
  const std::unique_ptr<SessionLog> log = core_.end_log();
  if (log == nullptr) return;
  if (end == End::closed) {
    log->close();
  } else if (!core_.has_diverged()) {
    log->keep(core_.moment(), core_.environment().clock.now(), true);
  }
}

void Session::save(PendingReply caller, SaveState save) {
  // On the pool: the session goes on meanwhile.
  const auto waiting = std::make_shared<PendingReply>(std::move(caller));
  boost::asio::post(strand_.get_inner_executor(),
                    [self = shared_from_this(), waiting, save = std::move(save),
                     moment = moment_to_save(core_), &environment = core_.environment()] {
                      try {
                        waiting->answer(save_moment(environment, self->id_, moment, save));
                      } catch (const StorageError& error) {
                        spdlog::error("session {}: not saved: {}", self->id_, error.what());
                        waiting->answer(storage_failed(error.kind()));
                      } catch (const std::exception& error) {
                        spdlog::error("session {}: not saved: {}", self->id_, error.what());
                        waiting->answer(internal_error());
                      }
                    });
}

}  // namespace vat
