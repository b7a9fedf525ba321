// Ends of sessions and of the server.

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <future>
#include <utility>

#include "core/support/check.h"
#include "server/directory/session_directory.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::chrono::milliseconds kShortestExpiryCheck(50);
constexpr std::chrono::milliseconds kLongestExpiryCheck(15'000);
constexpr std::chrono::milliseconds kShortestHandOver(5000);  // also without drain time
constexpr std::chrono::milliseconds kNever = std::chrono::hours(1'000'000);  // a century

/// Calls `post` with a task, and waits until the task is run.
template <class Post>
void wait_for_task(const Post& post) {
  std::promise<void> done;
  post([&done] { done.set_value(); });
  done.get_future().wait();
}

}  // namespace

std::optional<RpcError> SessionDirectory::close(PendingReply& reply, const SessionId& id,
                                                const std::string& reason) {
  const std::lock_guard lock(tables_.mutex);
  const auto* session = tables_.sessions.find(id);
  if (session == nullptr) return close_absent(reply, id);
  const SessionNumber number = session->first;
  const Client* client = tables_.clients.find(reply);
  if (client == nullptr || !admission_.may_close(*client, number)) {
    if (auto error = admission_.refuse_role(reply, number)) return error;
  }
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  forget_stored_then(number, [this, id, number, reason, waiting](auto failure) {
    if (failure) return waiting->answer(storage_failed(*failure));
    if (tables_.sessions.find(id) == nullptr) return waiting->answer(no_such_session(id));
    close_session(number, Session::End::closed, reason, std::move(*waiting));
  });
  return {};
}

std::optional<RpcError> SessionDirectory::close_absent(PendingReply& reply, const SessionId& id) {
  VAT_CHECK(tables_.mutex.is_held());
  const auto* absent = tables_.sessions.find_absent(id);
  if (absent == nullptr) {
    const auto elsewhere = find_elsewhere(id);
    if (!elsewhere) return no_such_session(id, "/session");
    return moved_to(id, resources_.cluster->url_of(*elsewhere).value_or(""));
  }
  const SessionNumber number = absent->first;
  if (auto error = admission_.refuse_role(reply, number)) return error;
  if (!absent->second.is_lost) return not_recovered(id, "recovering");
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  forget_stored_then(number, [this, id, number, waiting](auto failure) {
    if (failure) return waiting->answer(storage_failed(*failure));
    if (tables_.sessions.find_absent(id) == nullptr) return waiting->answer(no_such_session(id));
    resources_.storage->remove_closed();
    remove_tokens(id, Session::End::closed);
    tables_.sessions.remove_absent(number);
    waiting->answer(Json{{"tick", 0}});
  });
  return {};
}

void SessionDirectory::forget_stored_then(
    SessionNumber number, std::function<void(std::optional<StorageError::Kind>)> then) {
  VAT_CHECK(tables_.mutex.is_held());
  if (resources_.storage == nullptr || number >= kFirstReplay) return then({});
  auto forget = [this, number, then = std::move(then)](std::optional<StorageError::Kind> refused) {
    const auto done = [this, then](auto failure) {
      boost::asio::post(resources_.storage_requests, [this, then, failure] {
        const std::lock_guard lock(tables_.mutex);
        then(failure);
      });
    };
    if (refused) return done(refused);
    resources_.storage->journal().post(
        [&storage = *resources_.storage, number] { storage.sessions().close(number); }, done);
  };
  if (resources_.cluster == nullptr) return forget({});
  resources_.cluster->remove_session(number, std::move(forget));
}

void SessionDirectory::remove_tokens(const SessionId& id, Session::End end) {
  resources_.tokens.remove_session(id, end == Session::End::resumable);
}

void SessionDirectory::close_session(SessionNumber number, Session::End end,
                                     const std::string& reason, std::optional<PendingReply> reply) {
  VAT_CHECK(tables_.mutex.is_held());
  const SessionId id = to_id(number);
  const std::string closed = write_event("session.closed", {{"session", id}, {"reason", reason}});
  // Direct clients resume after the end of their connection, which relayed clients keep.
  const std::string moved = write_event("session.moved", {{"session", id}, {"url", ""}});
  tables_.clients.close_session(number, closed, end == Session::End::resumable ? moved : closed);
  tables_.sessions.at(number).close(end, std::move(reply));
  if (resources_.saved_in_memory) resources_.saved_in_memory->states.remove_session(id);
  remove_tokens(id, end);
  tables_.sessions.remove(number);
  log_info("session {} closed: {}", id, reason);
}

std::string SessionDirectory::metrics() {
  ServerMetrics::Gauges gauges;
  gauges.version = resources_.settings.version;
  gauges.instructions = resources_.settings.instructions;
  gauges.threads = resources_.runner.thread_count();
  gauges.memory = memory_use();
  {
    const std::lock_guard lock(tables_.mutex);
    gauges.connections = tables_.clients.size();
    if (resources_.storage) gauges.storage = resources_.storage->counts();
    for (const auto& [number, session] : tables_.sessions.running()) {
      const SessionSummary summary = session->summary();
      ++(summary.hibernating ? gauges.hibernating_sessions
         : summary.playing   ? gauges.playing_sessions
                             : gauges.paused_sessions);
      gauges.abandoned_sessions += admission_.is_abandoned(number) ? 1 : 0;
      gauges.clients += tables_.clients.count_in(number);
      gauges.particles += summary.particles;
    }
  }
  return resources_.metrics.to_text(gauges);
}

Json SessionDirectory::health() const {
  Json health{{"status", is_replaced() ? "replaced" : "ok"}, {"durability", "none"}};
  if (resources_.storage == nullptr) return health;
  health["durability"] = to_string(resources_.settings.storage.durability);
  const auto failing = resources_.storage->counts().failing;
  health["storage"] = failing ? "failing" : "ok";
  if (failing) health["reason"] = to_string(*failing);
  return health;
}

void SessionDirectory::drain(std::chrono::milliseconds time) {
  const std::chrono::duration<double> seconds = time;
  const std::string event = write_event("server.draining", {{"seconds", seconds.count()}});
  const auto timer = resources_.clock.make_timer(boost::asio::make_strand(resources_.pool));
  std::unique_lock lock(tables_.mutex);
  admission_.start_draining();
  timer->start(resources_.clock.now() + time, [this] {
    const std::lock_guard timer_lock(tables_.mutex);
    drain_time_is_over_ = true;
    drained_.notify_all();
  });
  for (const auto& [connection, client] : tables_.clients.all()) client.outbox->send(event);
  if (resources_.cluster) {
    lock.unlock();
    resources_.cluster->drain(std::max<std::chrono::milliseconds>(time, kShortestHandOver));
    lock.lock();
  }
  drained_.wait(lock, [this] { return drain_time_is_over_ || tables_.clients.size() == 0; });
  timer->cancel();
}

RpcResult SessionDirectory::request_drain(std::optional<std::chrono::milliseconds> time) {
  if (!resources_.settings.end) return not_allowed("clients cannot end this server");
  const std::chrono::duration<double> seconds = resources_.settings.end(time);
  return Json{{"seconds", seconds.count()}};
}

void SessionDirectory::flush() {
  if (admission_.stopped()) return;
  wait_for_task([this](auto done) { boost::asio::post(resources_.creations, done); });
  wait_for_task([this](auto done) { boost::asio::post(resources_.storage_requests, done); });
  std::vector<std::shared_ptr<Session>> sessions;
  {
    const std::lock_guard lock(tables_.mutex);
    for (const auto& [number, session] : tables_.sessions.running()) sessions.push_back(session);
  }
  for (const auto& session : sessions) {
    wait_for_task([&session](auto done) { session->post_behind(done); });
  }
  wait_for_task([this](auto done) { boost::asio::post(resources_.read_threads, done); });
  if (resources_.storage) resources_.storage->flush();
  wait_for_task([this](auto done) { boost::asio::post(resources_.storage_requests, done); });
}

void SessionDirectory::stop() {
  if (resources_.cluster) resources_.cluster->leave();
  {
    const std::lock_guard lock(tables_.mutex);
    admission_.stop();
    expiry_timer_->cancel();
    waiting_joins_.clear();
    while (const auto* session = tables_.sessions.first()) {
      close_session(session->first, Session::End::resumable, "the server stops", {});
    }
  }
  resources_.deferred->stop();
  recoverer_.join();
  resources_.read_threads.join();
  resources_.pool.join();
  resources_.storage_threads.join();
  resources_.frame_threads.join();
  if (resources_.storage) resources_.storage->flush();
  if (resources_.cluster == nullptr) return;
  resources_.cluster->stop();
  resources_.storage->flush();  // removals of lost sessions, which inform the node
}

std::chrono::milliseconds SessionDirectory::expiry_of(SessionNumber session) const {
  const ServerLimits& limits = resources_.settings.limits;
  const auto usual = limits.expire_after.count() > 0 ? limits.expire_after : kNever;
  return session >= kFirstReplay ? std::min(limits.replay_expire_after, usual) : usual;
}

void SessionDirectory::wait_for_expiry() {
  VAT_CHECK(tables_.mutex.is_held());
  const auto shortest = expiry_of(kFirstReplay);
  const auto interval = std::clamp(shortest / 4, kShortestExpiryCheck, kLongestExpiryCheck);
  expiry_timer_->start(resources_.clock.now() + interval, [this] { end_expired(); });
}

void SessionDirectory::end_expired() {
  const std::lock_guard lock(tables_.mutex);
  if (admission_.stopped()) return;
  const auto now = resources_.clock.now();
  resources_.downloads.forget_old(now);
  resources_.imports.forget_old(now);
  end_expired_sessions(now);
  wait_for_expiry();
}

void SessionDirectory::end_expired_sessions(SteadyClock::time_point now) {
  VAT_CHECK(tables_.mutex.is_held());
  std::vector<SessionNumber> expired;
  for (const auto& [number, session] : tables_.sessions.running()) {
    if (number == tables_.sessions.first()->first || tables_.clients.count_in(number) > 0) continue;
    const auto empty_since = session->summary().empty_since;
    if (empty_since && now - *empty_since >= expiry_of(number)) expired.push_back(number);
  }
  for (const SessionNumber number : expired) {
    forget_stored_then(number, [this, number](auto failure) {
      if (failure || !tables_.sessions.running().contains(number)) return;
      close_session(number, Session::End::closed, "the session had no participant for too long",
                    {});
    });
  }
}

}  // namespace vat
