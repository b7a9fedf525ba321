// Clients and sessions of a server.

#include "server/directory/session_directory.h"

#include <boost/asio/post.hpp>
#include <exception>
#include <utility>

#include "core/support/check.h"
#include "server/clients/answer_with.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {

SessionDirectory::SessionDirectory(const Catalogue& catalogue, ServerSettings settings,
                                   Clock& clock, const SessionMethods& methods)
    : resources_(catalogue, std::move(settings), clock, methods),
      admission_(resources_, tables_),
      access_(resources_, tables_, admission_),
      replay_opener_(resources_, tables_, admission_, access_),
      recoverer_(resources_, tables_, admission_,
                 [this](PendingReply& reply, const std::optional<SessionId>& id,
                        JoinRequest request) { return join(reply, id, std::move(request)); }),
      expiry_timer_(clock.make_timer(resources_.pool.get_executor())) {
  const std::lock_guard lock(tables_.mutex);
  wait_for_expiry();
}

SessionDirectory::~SessionDirectory() {
  try {
    stop();
  } catch (const std::exception& error) {  // the members still end their threads
    log_error("the sessions did not stop in order: {}", error.what());
  }
}

bool SessionDirectory::connect(std::shared_ptr<Connection> connection,
                               const std::optional<Grant>& access) {
  const std::lock_guard lock(tables_.mutex);
  if (!admission_.admits_connection()) return false;
  const ServerLimits& limits = resources_.settings.limits;
  auto outbox =
      std::make_shared<ClientOutbox>(std::move(connection), limits.max_control_queue_bytes);
  outbox->set_meter(std::make_unique<MessageMeter>(limits, resources_.clock.now()));
  if (resources_.cluster) outbox->set_gate(*resources_.cluster);
  outbox->set_read_budget(client_read_budget(limits, resources_.clock.now()));
  Client& client = tables_.clients.add(std::move(outbox));
  access_.start(client);
  client.is_relayed = access.has_value();
  if (access) client.access = *access;
  return true;
}

void SessionDirectory::disconnect(ConnectionId id) {
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(id);
  if (client == nullptr) return;
  if (client->relay != nullptr) client->relay->abandon();
  client->outbox->leave();
  if (client->session != 0) {
    tables_.sessions.at(client->session).disconnect(PendingReply(client->outbox, {}));
  }
  tables_.clients.remove(id);
  if (tables_.clients.size() == 0) drained_.notify_all();
}

SessionDirectory::Sender SessionDirectory::find_client(ConnectionId id) {
  const std::lock_guard lock(tables_.mutex);
  bound_queues();  // queues grow fast only if clients send messages
  Client* client = tables_.clients.find(id);
  if (client == nullptr || client->outbox->is_closed()) return {};
  if (client->relay != nullptr && client->relay->has_left()) client->relay.reset();
  return {client->outbox, client->access.role, client->relay};
}

bool SessionDirectory::is_ready() const {
  const std::lock_guard lock(tables_.mutex);
  return !admission_.stopped() && !admission_.is_draining() && !tables_.sessions.is_recovering();
}

std::optional<SessionDirectory::Stored> SessionDirectory::store(const std::string& name,
                                                                const Scene& scene,
                                                                InstructionSet instructions) {
  if (resources_.storage == nullptr) return {};
  StoredSession session;
  session.name = name;
  session.instruction_set = to_string(instructions);
  session.settings = write_settings({name, admission_.default_role(), false, 0}).dump();
  const std::string params = Json{{"scene", write_scene(scene)}}.dump();
  const LogEntry first{1, 0, 0, 0, std::string(kLoadMethod), params, false};
  if (resources_.cluster) {
    session.number =
        resources_.cluster->add_session(name, session.instruction_set, session.settings, first);
  }
  try {
    const SessionNumber number = resources_.storage->sessions().create(session, first);
    return Stored{number, params.size()};
  } catch (const StorageError&) {
    if (resources_.cluster) resources_.cluster->remove_session(session.number, [](auto) {});
    throw;
  }
}

void SessionDirectory::remove_stored(SessionNumber number) {
  resources_.storage->sessions().close(number);
  if (resources_.cluster) resources_.cluster->remove_session(number, [](auto) {});
}

InstructionSet SessionDirectory::instructions_for_new() const {
  const InstructionSet own = resources_.environment.instructions;
  return resources_.cluster ? resources_.cluster->common_instructions(own) : own;
}

std::variant<SessionId, RpcError> SessionDirectory::create(std::string name, const Scene& scene,
                                                           SessionCreator creator) {
  {
    const std::lock_guard lock(tables_.mutex);
    if (auto error = admission_.refuse_session()) return *std::move(error);
  }
  const SessionEnvironment& environment = resources_.environment;
  const InstructionSet instructions = instructions_for_new();
  auto chosen = with_device(scene, environment);
  if (auto* error = std::get_if<RpcError>(&chosen)) return std::move(*error);
  const Scene& with_choice = std::get<Scene>(chosen);
  auto simulation = make_on_device(with_choice, environment, instructions);
  if (auto* error = std::get_if<RpcError>(&simulation)) return std::move(*error);
  auto share = resources_.budget.take(resources_of(std::get<Simulation>(simulation)));
  if (const auto* excess = std::get_if<LimitExcess>(&share)) return limit_reached(*excess);
  std::optional<Stored> stored;
  try {
    stored = store(name, with_choice, instructions);
  } catch (const StorageError& error) {
    log_error("a session cannot be stored: {}", error.what());
    return storage_failed(error.kind());
  } catch (const NameInUse&) {
    return name_in_use();
  } catch (const NatsError& error) {
    log_error("a session cannot be stored: {}", error.what());
    return storage_failed(StorageError::Kind::unreachable);
  }

  std::unique_lock lock(tables_.mutex);  // not before: the above takes long
  if (auto error = admission_.refuse_session()) {
    lock.unlock();
    if (stored) remove_stored(stored->number);
    return *std::move(error);
  }
  const SessionNumber number = stored ? stored->number : tables_.sessions.next_number();
  auto core = std::make_unique<SessionCore>(
      to_id(number),
      SessionSettings{std::move(name), admission_.default_role(), false, creator.connection},
      std::get<Simulation>(std::move(simulation)), std::get<ResourceShare>(std::move(share)),
      environment);
  if (stored) {
    core->history().keep_in(std::make_unique<SessionLog>(
        *resources_.storage, number, SessionLog::Place{1, 0, false, stored->log_bytes, {}},
        resources_.cluster ? resources_.cluster->replica_of(number) : nullptr));
  }
  const auto session = std::make_shared<Session>(std::move(core), nullptr, resources_.pool,
                                                 resources_.slow_tick_gate);
  tables_.sessions.add(number, session, std::move(creator.place));
  session->start();
  log_info("session {} created: {}", to_id(number), scene.name);
  return to_id(number);
}

std::optional<RpcError> SessionDirectory::create_later(PendingReply& reply, std::string name,
                                                       Json scene, Level level) {
  const std::lock_guard lock(tables_.mutex);
  if (auto error = admission_.refuse_session()) return error;
  const Client* client = tables_.clients.find(reply);
  if (client != nullptr && !client->access.session.empty()) {
    return not_allowed("the token is for session " + client->access.session + " only");
  }
  // Counted now, so that waiting creations count too.
  auto admitted = admission_.admit_creator(reply);
  if (auto* error = std::get_if<RpcError>(&admitted)) return std::move(*error);
  boost::asio::post(
      resources_.creations,
      [this, creator = std::get<SessionCreator>(std::move(admitted)), reply = std::move(reply),
       name = std::move(name), scene = std::move(scene), level]() mutable {
        const ThreadPoolRunner::HelperReservation reservation(resources_.runner);
        answer_with(
            reply, "session.create failed",
            [&] { return create_from(scene, level, std::move(name), std::move(creator)); },
            [&](RpcResult result) { access_.answer_created(reply, std::move(result)); });
      });
  return {};
}

void SessionDirectory::use_storage(PendingReply& reply, std::function<RpcResult()> work) {
  boost::asio::post(resources_.storage_requests,
                    [reply = std::move(reply), work = std::move(work)]() mutable {
                      answer_with(reply, reply.method().name, work);
                    });
}

RpcResult SessionDirectory::create_from(const Json& scene, Level level, std::string name,
                                        SessionCreator creator) {
  {
    const std::lock_guard lock(tables_.mutex);
    if (auto error = admission_.refuse_session()) return *std::move(error);  // before the reading
  }
  if (auto created = create_elsewhere(scene, level, name)) {
    keep_ticket(creator.connection, *created);
    return *std::move(created);
  }
  auto read = read_named_scene(scene, level, resources_.environment);
  if (auto* error = std::get_if<RpcError>(&read)) return std::move(*error);
  auto created = create(std::move(name), std::get<Scene>(read), std::move(creator));
  if (auto* error = std::get_if<RpcError>(&created)) return std::move(*error);
  return Json{{"session", std::get<SessionId>(created)}, {"tick", 0}};
}

std::vector<ListedSession> SessionDirectory::list(const PendingReply& reply) const {
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(reply);
  std::vector<ListedSession> list;
  if (client == nullptr) return list;
  const std::string own_node = resources_.cluster ? resources_.cluster->name() : "";
  for (const auto& [number, session] : tables_.sessions.running()) {
    if (admission_.refuse_access(*client, number)) continue;
    const bool is_closable = admission_.may_close(*client, number);
    list.push_back({to_id(number), session->summary(), "running", is_closable, own_node});
    list.back().summary.clients = tables_.clients.count_in(number);
  }
  for (const auto& [number, absent] : tables_.sessions.absent()) {
    if (admission_.refuse_access(*client, number)) continue;
    SessionSummary summary;
    summary.name = absent.name;
    list.push_back({to_id(number), std::move(summary), absent.is_lost ? "lost" : "recovering",
                    absent.is_lost && client->access.role == Role::admin, own_node});
  }
  add_elsewhere(*client, list);
  return list;
}

std::optional<RpcError> SessionDirectory::join(PendingReply& reply,
                                               const std::optional<SessionId>& id,
                                               JoinRequest request) {
  return join_or_wait(reply, id, std::move(request), true);
}

std::optional<RpcError> SessionDirectory::join_or_wait(PendingReply& reply,
                                                       const std::optional<SessionId>& id,
                                                       JoinRequest request, bool may_wait) {
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(reply);
  if (client == nullptr) return not_allowed("the connection is closed");
  if (admission_.is_draining()) return not_allowed("the server is shutting down");
  const bool has_own = !id && !client->access.session.empty();
  const std::optional<SessionId> wanted = has_own ? client->access.session : id;
  if (access_.must_check(*client)) {
    access_.check_then(*client, [this, id, request = std::move(request),
                                 waiting = std::make_shared<PendingReply>(std::move(reply))](
                                    std::optional<RpcError> error) {
      if (!error) error = join(*waiting, id, request);
      if (error) waiting->answer(*std::move(error));
    });
    return {};
  }
  if (auto* absent = tables_.sessions.find_absent(wanted)) {
    if (auto error = admission_.refuse_access(*client, absent->first)) return error;
    if (absent->second.is_lost) return not_recovered(to_id(absent->first), "lost");
    absent->second.waiting.push_back({std::move(reply), std::move(request)});
    return {};
  }
  const auto* found = wanted ? tables_.sessions.find(*wanted) : tables_.sessions.first();
  if (found == nullptr) {
    bool is_missing = false;
    auto error = join_elsewhere(reply, wanted, request, is_missing);
    if (!is_missing) return error;
    if (may_wait && wait_for_replay(reply, wanted, request)) return {};
    return no_such_session(id ? *id : "at all", "/session");
  }
  const auto& [number, session] = *found;
  if (auto error = admission_.refuse_access(*client, number)) return error;
  const std::size_t maximum = resources_.settings.limits.max_clients_per_session;
  const std::size_t others = tables_.clients.count_in(number) - (client->session == number ? 1 : 0);
  if (others >= maximum) return limit_reached("clients_per_session", maximum);
  if (client->session != number) leave_session(*client, PendingReply(client->outbox, {}));
  client->session = number;
  const std::uint64_t membership = client->outbox->join();
  session->join(std::move(reply), membership, admission_.complete(std::move(request), *client),
                [this, connection = client->outbox->id(), number = number] {
                  undo_join(connection, number);
                });
  return {};
}

void SessionDirectory::undo_join(ConnectionId id, SessionNumber session) {
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(id);
  if (client == nullptr || client->session != session) return;
  client->outbox->leave();
  client->session = 0;
}

std::optional<RpcError> SessionDirectory::leave(PendingReply& reply) {
  const std::lock_guard lock(tables_.mutex);
  Client* const client = tables_.clients.find(reply);
  if (client == nullptr || (client->session == 0 && client->relay == nullptr)) return not_joined();
  leave_session(*client, std::move(reply));
  return {};
}

void SessionDirectory::leave_session(Client& client, PendingReply reply) {
  VAT_CHECK(tables_.mutex.is_held());
  if (client.relay != nullptr) return std::exchange(client.relay, nullptr)->leave(std::move(reply));
  if (client.session == 0) return;
  client.outbox->leave();
  tables_.sessions.at(client.session).leave(std::move(reply));
  client.session = 0;
}

std::optional<RpcError> SessionDirectory::post(PendingReply& reply, SessionCommand command) {
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(reply);
  if (client == nullptr || client->session == 0) return not_joined();
  tables_.sessions.at(client->session).post(std::move(reply), std::move(command));
  return {};
}

std::optional<std::uint64_t> SessionDirectory::tick_of(const PendingReply& reply) const {
  const std::lock_guard lock(tables_.mutex);
  const Client* client = tables_.clients.find(reply);
  if (client == nullptr) return {};
  if (client->relay != nullptr) return client->relay->tick();
  if (client->session == 0) return {};
  return tables_.sessions.at(client->session).summary().tick;
}

}  // namespace vat
