#include "server/session/session_directory.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <chrono>
#include <exception>
#include <future>
#include <limits>
#include <thread>

#include "server/heap.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

constexpr std::chrono::milliseconds kShortestExpiryCheck(50);
constexpr std::chrono::milliseconds kLongestExpiryCheck(15'000);
constexpr std::chrono::milliseconds kNever = std::chrono::hours(1'000'000);  // a century

// Two at least: the system then shares even a single core between a long tick and a short one.
std::size_t thread_count(std::size_t wanted) {
  if (wanted > 0) return wanted;
  return std::max<std::size_t>(2, std::thread::hardware_concurrency());
}

ServerLimits without_scene_limits(ServerLimits limits) {
  limits.max_springs = limits.max_particles = limits.max_particle_steps_per_tick =
      limits.max_grabs_per_client = std::numeric_limits<std::size_t>::max();
  return limits;
}

std::unique_ptr<Storage> open_storage(const ServerSettings& settings, Clock& clock) {
  if (settings.data_folder.empty()) return nullptr;
  return std::make_unique<Storage>(settings.data_folder, settings.storage, clock);
}

}  // namespace

SessionId to_id(std::uint64_t number) {
  if (number >= kFirstReplay) return "r" + std::to_string(number - kFirstReplay);
  return "s" + std::to_string(number);
}

SessionDirectory::SessionDirectory(const Catalogue& catalogue, ServerSettings settings,
                                   Clock& clock)
    : catalogue_(catalogue),
      settings_(std::move(settings)),
      runner_(thread_count(settings_.threads)),
      clock_(clock),
      tokens_(settings_.limits.max_tokens, clock),
      resources_({settings_.limits.max_particles_in_all, settings_.limits.max_springs_in_all}),
      slow_tick_gate_(runner_.thread_count()),
      frame_threads_(std::max<std::size_t>(1, runner_.thread_count() / 2)),
      storage_(open_storage(settings_, clock)),
      saved_in_memory_(storage_ ? nullptr : std::make_unique<SavedInMemory>()),
      environment_{catalogue_,
                   settings_.limits,
                   settings_.instructions,
                   runner_,
                   metrics_,
                   resources_,
                   frame_threads_,
                   tokens_,
                   clock_,
                   &downloads_,
                   storage_ ? &storage_->states() : &saved_in_memory_->states,
                   storage_ ? &storage_->scenes() : &saved_in_memory_->scenes},
      no_limits_(without_scene_limits(settings_.limits)),
      past_resources_(kUnlimitedResources),
      past_environment_{catalogue_, no_limits_,      settings_.instructions, runner_,
                        metrics_,   past_resources_, frame_threads_,         tokens_,
                        clock_,     &downloads_},
      pool_(2 * runner_.thread_count()),
      deferred_(std::make_shared<DeferredTasks>(pool_, clock)),
      creations_(boost::asio::make_strand(pool_)),
      expiry_timer_(clock.make_timer(pool_.get_executor())) {
  if (storage_) tokens_.keep_in(storage_->tokens());
  const std::lock_guard lock(mutex_);
  wait_for_expiry();
}

SessionDirectory::~SessionDirectory() {
  try {
    stop();
  } catch (const std::exception& error) {  // the members still end their threads
    spdlog::error("the sessions did not stop in order: {}", error.what());
  }
}

bool SessionDirectory::connect(std::shared_ptr<Connection> connection) {
  const std::lock_guard lock(mutex_);
  if (stopped_ || draining_ || clients_.size() >= settings_.limits.max_connections) return false;
  const ConnectionId id = connection->id();
  Client& client = clients_[id];
  client.outbox = std::make_shared<ClientOutbox>(std::move(connection),
                                                 settings_.limits.max_control_queue_bytes);
  client.outbox->set_meter(std::make_unique<MessageMeter>(settings_.limits, clock_.now()));
  if (settings_.access.mode == AccessMode::open) {
    client.access.role = Role::controller;
  } else {
    deferred_->add(clock_.now() + settings_.access.enter_time,
                   [this, id] { close_unless_entered(id); });
  }
  return true;
}

void SessionDirectory::disconnect(ConnectionId id) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(id);
  if (client == clients_.end()) return;
  Client& gone = client->second;
  gone.outbox->leave();
  if (gone.session != 0) sessions_.at(gone.session)->disconnect(PendingReply(gone.outbox, {}));
  clients_.erase(client);
  if (clients_.empty()) drained_.notify_all();
}

SessionDirectory::Sender SessionDirectory::find_client(ConnectionId id) const {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(id);
  if (client == clients_.end() || client->second.outbox->is_closed()) return {};
  return {client->second.outbox, client->second.access.role};
}

std::optional<RpcError> SessionDirectory::refuse_session() const {
  const std::lock_guard lock(mutex_);
  return refuse_session_locked();
}

std::optional<RpcError> SessionDirectory::refuse_session_locked() const {
  if (stopped_ || draining_) return not_allowed("the server stops");
  if (sessions_.size() + absent_.size() < settings_.limits.max_sessions) return {};
  return limit_reached("sessions", settings_.limits.max_sessions);
}

Role SessionDirectory::default_role() const {
  return settings_.access.mode == AccessMode::open ? Role::controller : Role::viewer;
}

std::variant<SessionId, RpcError> SessionDirectory::create(std::string name, const Scene& scene,
                                                           SessionCreator creator) {
  if (auto error = refuse_session()) return *std::move(error);
  auto simulation = make_simulation(scene, environment_, environment_.instructions);
  if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
  auto share = resources_.take(resources_of(std::get<Simulation>(simulation)));
  if (const auto* excess = std::get_if<ResourceExcess>(&share)) return limit_reached(*excess);
  std::optional<std::uint64_t> stored;
  try {
    stored = store(name, scene);
  } catch (const StorageError& error) {
    spdlog::error("a session cannot be kept: {}", error.what());
    return storage_failed(error.kind());
  }

  const std::lock_guard lock(mutex_);  // from here on only: the above took long
  if (auto error = refuse_session_locked()) {
    if (stored) storage_->sessions().close(*stored);
    return *std::move(error);
  }
  const Sessions::key_type number = stored ? *stored : ++last_session_;
  const auto session = std::make_shared<Session>(
      to_id(number), SessionSettings{std::move(name), default_role(), false, creator.connection},
      std::get<Simulation>(std::move(simulation)), std::get<ResourceShare>(std::move(share)),
      environment_, pool_, slow_tick_gate_);
  if (stored) {
    session->keep_in(std::make_unique<SessionLog>(*storage_, number, SessionLog::Place{1, 0}));
  }
  sessions_.emplace(number, session);
  places_.emplace(number, std::move(creator.place));
  session->start();
  spdlog::info("session {} created: {}", to_id(number), scene.name);
  return to_id(number);
}

std::optional<RpcError> SessionDirectory::create_later(PendingReply& caller, std::string name,
                                                       Json scene) {
  const std::lock_guard lock(mutex_);
  if (auto error = refuse_session_locked()) return error;
  const Client* client = find_caller(caller);
  if (client != nullptr && !client->access.session.empty()) {
    return not_allowed("the token is for session " + client->access.session + " only");
  }
  // From here on, so that those that wait for their turn are counted too.
  const std::size_t most = settings_.limits.max_sessions_per_address;
  SessionCreator creator{caller.client()->id(),
                         sessions_by_address_.take(caller.client()->address(), most)};
  if (creator.place == nullptr) return limit_reached("sessions_per_address", most);
  boost::asio::post(creations_, [this, creator = std::move(creator), caller = std::move(caller),
                                 name = std::move(name), scene = std::move(scene)]() mutable {
    const ThreadPoolRunner::HelperReservation guest(runner_);
    try {
      caller.answer(create_from(scene, std::move(name), std::move(creator)));
    } catch (const std::exception& error) {
      spdlog::error("session.create failed: {}", error.what());
      caller.answer(internal_error());
    }
  });
  return {};
}

RpcResult SessionDirectory::create_from(const Json& scene, std::string name,
                                        SessionCreator creator) {
  if (auto error = refuse_session()) return *std::move(error);  // others were before it
  auto read = read_named_scene(scene, environment_);
  if (auto* error = std::get_if<RpcError>(&read)) return std::move(*error);
  auto created = create(std::move(name), std::get<Scene>(read), std::move(creator));
  if (auto* error = std::get_if<RpcError>(&created)) return std::move(*error);
  return Json{{"session", std::get<SessionId>(created)}, {"tick", 0}};
}

std::vector<SessionDirectory::Listed> SessionDirectory::list(const PendingReply& caller) const {
  const std::lock_guard lock(mutex_);
  const Client* client = find_caller(caller);
  std::vector<Listed> list;
  for (const auto& [number, session] : sessions_) {
    if (client == nullptr || refuse_access(*client, number)) continue;
    list.push_back({to_id(number), session->summary(), "running"});
    list.back().summary.clients = client_count(number);
  }
  for (const auto& [number, absent] : absent_) {
    if (client == nullptr || refuse_access(*client, number)) continue;
    SessionSummary summary;
    summary.name = absent.name;
    list.push_back({to_id(number), std::move(summary), absent.is_lost ? "lost" : "recovering"});
  }
  return list;
}

std::optional<RpcError> SessionDirectory::join(PendingReply& caller,
                                               const std::optional<SessionId>& id,
                                               JoinRequest join_request) {
  const std::lock_guard lock(mutex_);
  const auto found = clients_.find(caller.client()->id());
  if (found == clients_.end()) return not_allowed("the connection is closed");
  if (draining_) return not_allowed("the server stops");
  Client& client = found->second;
  const bool has_own = !id && !client.access.session.empty();
  const std::optional<SessionId> wanted = has_own ? client.access.session : id;
  if (const auto absent = find_absent(wanted); absent != absent_.end()) {
    if (auto error = refuse_access(client, absent->first)) return error;
    return wait_for(absent->second, to_id(absent->first), caller, std::move(join_request));
  }
  const auto session = wanted ? find_session(*wanted) : sessions_.begin();
  if (session == sessions_.end()) return no_such_session(id ? *id : "at all", "/session");
  if (auto error = refuse_access(client, session->first)) return error;
  const std::size_t others =
      client_count(session->first) - (client.session == session->first ? 1 : 0);
  if (others >= settings_.limits.max_clients_per_session) {
    return limit_reached("clients_per_session", settings_.limits.max_clients_per_session);
  }
  if (client.session != session->first) leave_session(client, PendingReply(client.outbox, {}));
  client.session = session->first;
  session->second->join(std::move(caller), client.outbox->join(),
                        complete(std::move(join_request), client),
                        [this, connection = client.outbox->id(), number = session->first] {
                          undo_join(connection, number);
                        });
  return {};
}

std::optional<RpcError> SessionDirectory::leave(PendingReply& caller) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(caller.client()->id());
  if (client == clients_.end() || client->second.session == 0) return not_joined();
  leave_session(client->second, std::move(caller));
  return {};
}

std::optional<RpcError> SessionDirectory::post(PendingReply& caller, SessionCommand command) {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(caller.client()->id());
  if (client == clients_.end() || client->second.session == 0) return not_joined();
  sessions_.at(client->second.session)->post(std::move(caller), std::move(command));
  return {};
}

std::optional<RpcError> SessionDirectory::close(PendingReply& caller, const SessionId& id,
                                                const std::string& reason) {
  const std::lock_guard lock(mutex_);
  const auto session = find_session(id);
  if (session == sessions_.end()) return close_absent(id, caller);
  if (auto error = refuse_role(caller, rules_of("session.close"), session->first)) return error;
  if (const auto failure = forget_session(session->first)) return storage_failed(*failure);
  close_session(session, Session::End::closed, reason, std::move(caller));
  return {};
}

std::optional<std::uint64_t> SessionDirectory::tick_of(const PendingReply& caller) const {
  const std::lock_guard lock(mutex_);
  const auto client = clients_.find(caller.client()->id());
  if (client == clients_.end() || client->second.session == 0) return {};
  return sessions_.at(client->second.session)->summary().tick;
}

std::string SessionDirectory::metrics() const {
  ServerMetrics::Gauges present;
  present.version = settings_.version;
  present.instructions = settings_.instructions;
  present.threads = runner_.thread_count();
  present.heap = heap_in_use();
  {
    const std::lock_guard lock(mutex_);
    present.connections = clients_.size();
    if (storage_) present.storage = storage_->counts();
    for (const auto& [number, session] : sessions_) {
      const SessionSummary summary = session->summary();
      ++(summary.hibernating ? present.hibernating_sessions
         : summary.playing   ? present.playing_sessions
                             : present.paused_sessions);
      present.clients += client_count(number);
      present.particles += summary.particles;
    }
  }
  return metrics_.to_text(present);
}

void SessionDirectory::drain(std::chrono::milliseconds time) {
  const std::chrono::duration<double> seconds = time;
  const std::string event = write_event("server.draining", {{"seconds", seconds.count()}});
  const std::unique_ptr<Timer> timer = clock_.make_timer(boost::asio::make_strand(pool_));
  std::unique_lock lock(mutex_);
  draining_ = true;
  timer->start(clock_.now() + time, [this] {
    const std::lock_guard timer_lock(mutex_);
    drain_time_is_over_ = true;
    drained_.notify_all();
  });
  for (auto& [connection, client] : clients_) client.outbox->send(event);
  drained_.wait(lock, [this] { return drain_time_is_over_ || clients_.empty(); });
  timer->cancel();
}

RpcResult SessionDirectory::request_drain(std::optional<std::chrono::milliseconds> time) {
  if (!settings_.end) return not_allowed("this server is not ended by its clients");
  const std::chrono::duration<double> given = settings_.end(time);
  return Json{{"seconds", given.count()}};
}

void SessionDirectory::flush() {
  if (stopped_) return;
  const auto wait_for = [](const auto& post) {
    std::promise<void> done;
    post([&done] { done.set_value(); });
    done.get_future().wait();
  };
  wait_for([this](auto done) { boost::asio::post(creations_, done); });
  std::vector<std::shared_ptr<Session>> sessions;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, session] : sessions_) sessions.push_back(session);
  }
  for (const auto& session : sessions) {
    wait_for([&session](auto done) { session->post_behind(done); });
  }
  if (storage_) storage_->flush();
}

void SessionDirectory::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopped_ = true;
    expiry_timer_->cancel();
    while (!sessions_.empty()) {
      close_session(sessions_.begin(), Session::End::may_come_back, "the server stops", {});
    }
  }
  deferred_->stop();
  if (recovery_threads_) recovery_threads_->join();
  pool_.join();
  frame_threads_.join();
  if (storage_) storage_->flush();
}

void SessionDirectory::wait_for_expiry() {
  const auto soonest = patience_with(kFirstReplay);
  const auto interval = std::clamp(soonest / 4, kShortestExpiryCheck, kLongestExpiryCheck);
  expiry_timer_->start(clock_.now() + interval, [this] { end_expired(); });
}

void SessionDirectory::end_expired() {
  const std::lock_guard lock(mutex_);
  if (stopped_) return;
  const auto now = clock_.now();
  downloads_.forget_old(now);
  imports_.forget_old(now);
  end_expired_sessions(now);
  wait_for_expiry();
}

std::chrono::milliseconds SessionDirectory::patience_with(Sessions::key_type session) const {
  const ServerLimits& limits = settings_.limits;
  const auto usual = limits.expire_after.count() > 0 ? limits.expire_after : kNever;
  return session >= kFirstReplay ? std::min(limits.replay_expire_after, usual) : usual;
}

void SessionDirectory::end_expired_sessions(SteadyClock::time_point now) {
  for (auto next = sessions_.begin(); next != sessions_.end();) {
    const auto session = next++;
    if (session == sessions_.begin() || client_count(session->first) > 0) continue;
    const auto after = patience_with(session->first);
    const auto empty_since = session->second->summary().empty_since;
    if (empty_since && now - *empty_since >= after && !forget_session(session->first)) {
      close_session(session, Session::End::closed, "nobody was in it for too long", {});
    }
  }
}

SessionDirectory::Sessions::iterator SessionDirectory::find_session(const SessionId& id) {
  return std::ranges::find_if(sessions_,
                              [&](const auto& entry) { return to_id(entry.first) == id; });
}

std::size_t SessionDirectory::client_count(Sessions::key_type session) const {
  return static_cast<std::size_t>(std::ranges::count_if(
      clients_, [&](const auto& entry) { return entry.second.session == session; }));
}

void SessionDirectory::leave_session(Client& client, PendingReply caller) {
  if (client.session == 0) return;
  client.outbox->leave();
  sessions_.at(client.session)->leave(std::move(caller));
  client.session = 0;
}

void SessionDirectory::close_session(Sessions::iterator session, Session::End end,
                                     const std::string& reason,
                                     std::optional<PendingReply> caller) {
  const SessionId id = to_id(session->first);
  const std::string event = write_event("session.closed", {{"session", id}, {"reason", reason}});
  for (auto& [connection, client] : clients_) {
    if (client.session != session->first) continue;
    client.session = 0;
    client.outbox->leave();
    client.outbox->send(event);  // the last that it hears of the session
  }
  session->second->close(end, std::move(caller));
  if (saved_in_memory_) saved_in_memory_->states.remove_session(id);
  remove_tokens(id, end);
  places_.erase(session->first);
  sessions_.erase(session);
  spdlog::info("session {} closed: {}", id, reason);
}

}  // namespace vat
