// Sessions that are kept, and how they come back.

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "server/session/scene_loading.h"
#include "server/session/session_directory.h"

namespace vat {

std::optional<std::uint64_t> SessionDirectory::store(const std::string& name, const Scene& scene) {
  if (storage_ == nullptr) return {};
  StoredSession session;
  session.name = name;
  session.instruction_set = to_string(environment_.instructions);
  session.settings = write_settings({name, default_role(), false, 0}).dump();
  const Json params{{"scene", write_scene(scene)}};
  return storage_->sessions().create(session,
                                     {1, 0, 0, 0, std::string(kLoadMethod), params.dump(), false});
}

std::optional<StorageError::Kind> SessionDirectory::forget_session(Sessions::key_type number) {
  try {
    if (storage_ && number < kFirstReplay) storage_->sessions().close(number);
    return {};
  } catch (const StorageError& error) {
    spdlog::error("session {} cannot be closed: {}", to_id(number), error.what());
    return error.kind();
  }
}

void SessionDirectory::remove_tokens(const SessionId& id, Session::End end) {
  try {
    tokens_.remove_session(id, end == Session::End::may_come_back);
  } catch (const StorageError& error) {
    // They are good for nothing without their session.
    spdlog::error("session {}: its invitations stay until they end: {}", id, error.what());
  }
}

std::size_t SessionDirectory::recover() {
  if (storage_ == nullptr) return 0;
  std::vector<StoredSession> stored = storage_->sessions().sessions();
  const std::lock_guard lock(mutex_);
  if (stored.empty() || stopped_) return stored.size();
  recovery_threads_ =
      std::make_unique<boost::asio::thread_pool>(std::min(stored.size(), runner_.thread_count()));
  for (const StoredSession& session : stored) absent_[session.number].name = session.name;
  for (StoredSession& session : stored) {
    boost::asio::post(*recovery_threads_,
                      [this, session = std::move(session)] { recover_session(session); });
  }
  return absent_.size();
}

bool SessionDirectory::is_ready() const {
  const std::lock_guard lock(mutex_);
  return !stopped_ && !draining_ &&
         std::ranges::all_of(absent_, [](const auto& a) { return a.second.is_lost; });
}

void SessionDirectory::recover_session(const StoredSession& stored) {
  const ThreadPoolRunner::HelperReservation guest(runner_);
  try {
    end_recovery(stored, make_recovered(stored));
  } catch (const Cancelled&) {
    spdlog::info("session {} stays where it was", to_id(stored.number));
  } catch (const std::exception& error) {
    spdlog::error("session {} ({}) cannot be brought back, and stays in {} as it is: {}",
                  to_id(stored.number), stored.name, storage_->folder(), error.what());
    end_recovery(stored, nullptr);
  }
}

std::shared_ptr<Session> SessionDirectory::make_recovered(const StoredSession& stored) {
  const auto begin = CostClock::now();
  SessionRecovery recovery(*storage_, stored, past_environment_, stopped_);
  Simulation simulation = recovery.begin();
  ResourceShare share = past_resources_.take_anyway(resources_of(simulation));
  auto session = std::make_shared<Session>(
      to_id(stored.number), read_settings(stored.name, stored.settings), std::move(simulation),
      std::move(share), past_environment_, pool_, slow_tick_gate_);
  session->recover(recovery, *storage_, environment_);
  const std::chrono::duration<double> time = CostClock::now() - begin;
  spdlog::info("session {} is back at tick {}, in {:.2f} s", to_id(stored.number),
               session->summary().tick, time.count());
  return session;
}

void SessionDirectory::end_recovery(const StoredSession& stored, std::shared_ptr<Session> session) {
  std::vector<Absent::Waiting> waiting;
  {
    const std::lock_guard lock(mutex_);
    if (stopped_) return;
    Absent& absent = absent_.at(stored.number);
    waiting = std::move(absent.waiting);
    if (session == nullptr) {
      absent.is_lost = true;
    } else {
      absent_.erase(stored.number);
      sessions_.emplace(stored.number, session);
      session->start();
    }
  }
  for (Absent::Waiting& one : waiting) {
    if (auto error = join(one.caller, to_id(stored.number), std::move(one.join_request))) {
      one.caller.answer(*std::move(error));
    }
  }
}

std::map<std::uint64_t, SessionDirectory::Absent>::iterator SessionDirectory::find_absent(
    const std::optional<SessionId>& id) {
  if (id) {
    return std::ranges::find_if(absent_,
                                [&](const auto& entry) { return to_id(entry.first) == *id; });
  }
  // The first session, if it is among them.
  const auto first =
      std::ranges::find_if(absent_, [](const auto& entry) { return !entry.second.is_lost; });
  if (first == absent_.end() || sessions_.empty()) return first;
  return first->first < sessions_.begin()->first ? first : absent_.end();
}

std::optional<RpcError> SessionDirectory::wait_for(Absent& absent, const SessionId& id,
                                                   PendingReply& caller, JoinRequest join_request) {
  if (absent.is_lost) return not_recovered(id, "lost");
  absent.waiting.push_back({std::move(caller), std::move(join_request)});
  return {};
}

RpcError SessionDirectory::refuse_missing(const Client& client, const SessionId& id) {
  const auto absent = find_absent(id);
  if (absent == absent_.end() || refuse_access(client, absent->first)) {
    return no_such_session(id, "/session");
  }
  return not_recovered(id, absent->second.is_lost ? "lost" : "recovering");
}

std::optional<RpcError> SessionDirectory::close_absent(const SessionId& id, PendingReply& caller) {
  const auto absent = find_absent(id);
  if (absent == absent_.end()) return no_such_session(id, "/session");
  if (auto error = refuse_role(caller, rules_of("session.close"), absent->first)) return error;
  if (!absent->second.is_lost) return not_recovered(id, "recovering");
  if (const auto failure = forget_session(absent->first)) return storage_failed(*failure);
  storage_->remove_closed();
  remove_tokens(id, Session::End::closed);
  absent_.erase(absent);
  caller.answer(Json{{"tick", 0}});
  return {};
}

}  // namespace vat
