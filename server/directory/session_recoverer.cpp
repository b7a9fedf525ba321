#include "server/directory/session_recoverer.h"

#include <algorithm>
#include <boost/asio/post.hpp>
#include <exception>
#include <utility>
#include <vector>

#include "core/support/check.h"
#include "server/replay/log_replay.h"
#include "server/replay/session_recovery.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {

SessionRecoverer::SessionRecoverer(ServerResources& resources, DirectoryTables& tables,
                                   const Admission& admission, Join join)
    : resources_(resources), tables_(tables), admission_(admission), join_(std::move(join)) {}

std::size_t SessionRecoverer::start() {
  if (resources_.storage == nullptr) return 0;
  std::vector<StoredSession> stored = resources_.storage->sessions().sessions();
  const std::lock_guard lock(tables_.mutex);
  if (stored.empty() || admission_.stopped()) return stored.size();
  VAT_CHECK(threads_ == nullptr);
  threads_ = std::make_unique<boost::asio::thread_pool>(
      std::min(stored.size(), resources_.runner.thread_count()));
  const std::size_t count = stored.size();
  for (StoredSession& session : stored) post(std::move(session));
  return count;
}

void SessionRecoverer::start(const StoredSession& session) {
  const std::lock_guard lock(tables_.mutex);
  if (admission_.stopped() || tables_.sessions.running().contains(session.number)) return;
  if (threads_ == nullptr) {
    threads_ = std::make_unique<boost::asio::thread_pool>(resources_.runner.thread_count());
  }
  post(session);
}

void SessionRecoverer::post(StoredSession session) {
  VAT_CHECK(tables_.mutex.is_held());
  const std::uint64_t number = tables_.sessions.add_absent(session.number, session.name);
  boost::asio::post(*threads_,
                    [this, session = std::move(session), number] { recover(session, number); });
}

void SessionRecoverer::join() {
  if (threads_) threads_->join();
}

void SessionRecoverer::recover(const StoredSession& stored, std::uint64_t recovery) {
  const ThreadPoolRunner::HelperReservation reservation(resources_.runner);
  try {
    finish(stored, recovery, make_session(stored));
  } catch (const Cancelled&) {
    log_info("session {}: recovery cancelled", to_id(stored.number));
  } catch (const std::exception& error) {
    log_error("session {} ({}) cannot be recovered, and stays in {} unchanged: {}",
              to_id(stored.number), stored.name, resources_.storage->folder(), error.what());
    finish(stored, recovery, nullptr);
  }
}

std::shared_ptr<Session> SessionRecoverer::make_session(const StoredSession& stored) {
  const auto begin = CostClock::now();
  const SessionEnvironment& environment = resources_.recovery_environment;
  SessionRecovery recovery(*resources_.storage, stored, environment, admission_.stopped());
  Simulation simulation = recovery.begin();
  ResourceShare share = resources_.recovery_budget.take_anyway(resources_of(simulation));
  auto core = std::make_unique<SessionCore>(to_id(stored.number),
                                            read_settings(stored.name, stored.settings),
                                            std::move(simulation), std::move(share), environment);
  recovery.repeat_log(*core);
  recovery.finish(*core, resources_.environment);
  auto session = std::make_shared<Session>(std::move(core), nullptr, resources_.pool,
                                           resources_.slow_tick_gate);
  const std::chrono::duration<double> time = CostClock::now() - begin;
  log_info("session {} is recovered at tick {}, in {:.2f} s", to_id(stored.number),
           session->summary().tick, time.count());
  return session;
}

void SessionRecoverer::finish(const StoredSession& stored, std::uint64_t recovery,
                              std::shared_ptr<Session> session) {
  std::vector<AbsentSession::Waiting> waiting;
  {
    const std::lock_guard lock(tables_.mutex);
    if (admission_.stopped()) return;
    AbsentSession* const absent = tables_.sessions.find_recovering(stored.number, recovery);
    if (absent == nullptr) return;
    waiting = std::move(absent->waiting);
    if (session == nullptr) {
      absent->is_lost = true;
    } else {
      tables_.sessions.remove_absent(stored.number);
      tables_.sessions.add(stored.number, session, nullptr);
      session->start();
    }
  }
  for (AbsentSession::Waiting& one : waiting) {
    if (auto error = join_(one.reply, to_id(stored.number), std::move(one.request))) {
      one.reply.answer(*std::move(error));
    }
  }
}

}  // namespace vat
