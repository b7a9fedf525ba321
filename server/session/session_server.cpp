#include "server/session/session_server.h"

#include <spdlog/spdlog.h>

#include <exception>
#include <utility>

#include "server/session/method_table.h"

namespace vat {
namespace {

constexpr std::uint16_t kTooManyConnections = 1013;
constexpr std::uint16_t kFlooding = 4009;

Errors to_errors(const RpcError& error) {
  Errors errors;
  if (const auto list = error.data.find("errors"); list != error.data.end()) {
    for (const Json& entry : *list) {
      errors.push_back({entry.at("code"), entry.at("path"), entry.at("message")});
    }
  }
  if (errors.empty()) {
    errors.push_back({std::string(error_row(error.kind).name), "", error.message});
  }
  return errors;
}

}  // namespace

class SessionServer::Impl {
 public:
  Impl(const Catalogue& catalogue, ServerSettings settings, Clock& clock)
      : directory_(catalogue, std::move(settings), clock) {}

  SessionDirectory& directory() { return directory_; }

  /// Carries out a message. An error is answered to the id that was found, or to null.
  void receive(const SessionDirectory::Sender& sender, std::string_view message) {
    const std::shared_ptr<ClientOutbox>& client = sender.outbox;
    std::optional<Json> id;
    try {
      const auto now = directory_.clock().now();
      if (auto excess = client->meter()->count_bytes(message.size(), now)) {
        return refuse(*client, id, *excess);
      }
      auto request = read(message, sender.role, id);
      if (auto excess = client->meter()->count(class_of(request), now)) {
        return refuse(*client, id, *excess);
      }
      if (auto* error = std::get_if<RpcError>(&request)) {
        client->send(write_reply(id.value_or(nullptr), std::move(*error)));
        return;
      }
      PendingReply caller(client, id, &directory_.counters());
      if (auto result =
              call(caller, sender.role, std::get<RpcRequest>(std::move(request)), message.size())) {
        caller.answer(*std::move(result));
      }
    } catch (const StorageError& error) {
      spdlog::error("a message failed: {}", error.what());
      client->send(write_reply(id.value_or(nullptr), storage_failed(error.kind())));
    } catch (const std::exception& error) {
      spdlog::error("a message failed: {}", error.what());
      client->send(write_reply(id.value_or(nullptr), internal_error()));
    }
  }

  /// False where the message came too soon and is not answered.
  bool count_binary(ClientOutbox& client, std::size_t bytes) {
    const auto now = directory_.clock().now();
    auto excess = client.meter()->count_bytes(bytes, now);
    if (!excess) excess = client.meter()->count(MessageClass::query, now);
    if (excess) refuse(client, {}, *excess);
    return !excess;
  }

  void count_refusal(std::string_view limit) { directory_.counters().add_refusal(limit); }
  void count_close(std::uint16_t code) { directory_.counters().add_close(code); }

 private:
  const ServerLimits& limits() const { return directory_.settings().limits; }

  /// Of what is no request, or names no method: that of a question.
  static MessageClass class_of(const std::variant<RpcRequest, RpcError>& request) {
    const auto* good = std::get_if<RpcRequest>(&request);
    const Method* method = good == nullptr ? nullptr : find_method(good->method);
    return method == nullptr ? MessageClass::query : method->rules.message_class;
  }

  /// Answers what came too soon; who sends on regardless is closed.
  void refuse(ClientOutbox& client, const std::optional<Json>& id, const RateExcess& excess) {
    directory_.counters().add_rate_limited(excess.limit);
    if (excess.is_flood) return client.close(kFlooding, "too many messages");
    if (!id) return;  // a notification, or not read
    const RpcError error = rate_limited(excess.limit, excess.maximum, excess.retry_after.count());
    client.send(write_reply(*id, error));
  }

  std::variant<RpcRequest, RpcError> read(std::string_view message, Role role,
                                          std::optional<Json>& id) const {
    // Who has not been let in has nothing long to say.
    if (role == Role::none && message.size() > limits().max_message_bytes) {
      return limit_reached("message_bytes", limits().max_message_bytes);
    }
    if (message.size() > limits().max_scene_message_bytes) {
      return limit_reached("scene_message_bytes", limits().max_scene_message_bytes);
    }
    Result<Json> json = parse_json(
        message, {message.size(), limits().max_message_depth, limits().max_message_values});
    if (!json) return parse_failed(json.errors().front());
    return read_request(std::move(json).value(), id);
  }

  /// The answer, unless someone has taken the caller to answer later.
  std::optional<RpcResult> call(PendingReply& caller, Role role, RpcRequest request,
                                std::size_t bytes) {
    const Method* method = find_method(request.method);
    if (role == Role::none && (method == nullptr || method->rules.least_role > Role::none)) {
      return not_authenticated("the first message has to be access.enter");
    }
    if (method == nullptr) return method_not_found(request.method);
    if (method->rules.message_class != MessageClass::scene && bytes > limits().max_message_bytes) {
      return limit_reached("message_bytes", limits().max_message_bytes);
    }
    if (auto error =
            caller.count(bytes, limits().max_commands_in_flight, limits().max_bytes_in_flight)) {
      return *std::move(error);
    }
    Errors errors;
    ObjectReader params(request.params, "", errors);
    if (const auto* read = std::get_if<Method::ForServer>(&method->read)) {
      if (!method->rules.is_of_named_session) {
        if (auto error = refuse_role(method->rules, role)) return *std::move(error);
      }
      const ServerAction action = (*read)(params, errors);
      params.refuse_unknown();
      if (!errors.empty()) return invalid_params(errors);
      return action(directory_, caller);
    }
    SessionCommand command;
    command.rules = &method->rules;
    command.action = std::get<Method::ForSession>(method->read)(params, errors);
    params.refuse_unknown();
    if (!errors.empty()) return invalid_params(errors);
    command.params = std::move(request.params);
    if (auto error = directory_.post(caller, std::move(command))) return *std::move(error);
    return {};
  }

  SessionDirectory directory_;
};

SessionServer::SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock)
    : impl_(std::make_unique<Impl>(catalogue, std::move(settings), clock)) {}

SessionServer::~SessionServer() = default;

Result<SessionId> SessionServer::create_session(std::string name, const Scene& scene) {
  auto created = impl_->directory().create(std::move(name), scene, {});
  if (const auto* error = std::get_if<RpcError>(&created)) return to_errors(*error);
  return std::get<SessionId>(std::move(created));
}

std::size_t SessionServer::recover() {
  return impl_->directory().recover();
}

bool SessionServer::is_ready() const {
  return impl_->directory().is_ready();
}

std::string SessionServer::metrics() const {
  return impl_->directory().metrics();
}

void SessionServer::drain(std::chrono::milliseconds time) {
  impl_->directory().drain(time);
}

void SessionServer::flush() {
  impl_->directory().flush();
}

Downloads& SessionServer::downloads() {
  return impl_->directory().downloads();
}

void SessionServer::count_refusal(std::string_view limit) {
  impl_->count_refusal(limit);
}

void SessionServer::count_close(std::uint16_t code) {
  impl_->count_close(code);
}

void SessionServer::stop() {
  impl_->directory().stop();
}

void SessionServer::opened(std::shared_ptr<Connection> connection) {
  if (!impl_->directory().connect(connection)) {
    connection->close(kTooManyConnections, "too many connections");
  }
}

void SessionServer::text_received(ConnectionId id, std::string_view message) {
  const SessionDirectory::Sender sender = impl_->directory().find_client(id);
  if (sender.outbox != nullptr) impl_->receive(sender, message);
}

void SessionServer::binary_received(ConnectionId id, std::string_view message) {
  const std::shared_ptr<ClientOutbox> client = impl_->directory().find_client(id).outbox;
  if (client == nullptr || !impl_->count_binary(*client, message.size())) return;
  client->send(write_reply(nullptr, invalid_request("binary messages are for frames from here")));
}

void SessionServer::closed(ConnectionId id) {
  impl_->directory().disconnect(id);
}

}  // namespace vat
