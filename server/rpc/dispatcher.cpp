#include "server/rpc/dispatcher.h"

#include <exception>
#include <utility>

#include "core/support/check.h"
#include "core/support/nearest_name.h"
#include "server/methods/parts.h"
#include "server/rpc/method_table.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::uint16_t kFlooding = 4009;

/// Messages that are no request, or name no method, count as queries.
RateClass class_of(const std::variant<RpcRequest, RpcError>& request) {
  const auto* good = std::get_if<RpcRequest>(&request);
  const Method* method = good == nullptr ? nullptr : find_method(good->method);
  return method == nullptr ? RateClass::query : method->row.rate_class;
}

bool controls_frames(std::string_view method) {
  return method == "frames.subscribe" || method == "frames.unsubscribe";
}

/// Returns whether the parameters of the method name a session whose node answers.
bool names_session(const MethodRow& row) {
  return row.role_source == RoleSource::named || row.name == "server.move";
}

/// Returns whether the node of the client's session answers the request, and not this node.
bool is_for_owner(const RpcRequest& request, const std::string& session) {
  const Method* method = find_method(request.method);
  if (method == nullptr) return false;
  const MethodRow& row = method->row;
  if (row.role_source == RoleSource::named) {
    const auto named = request.params.find("session");
    return named != request.params.end() && *named == session;
  }
  return std::holds_alternative<SessionHandler>(method->handler) && !controls_frames(row.name);
}

RpcError unknown_method(std::string_view name) {
  NearestName nearest(name);
  for (const Method& method : all_methods()) nearest.consider(method.row.name);
  return with_suggestion(method_not_found(name), nearest.suggestion());
}

}  // namespace

void Dispatcher::receive(const SessionDirectory::Sender& sender, std::string_view message) {
  VAT_CHECK(sender.outbox != nullptr && sender.outbox->meter() != nullptr);
  ClientOutbox& client = *sender.outbox;
  std::optional<Json> id;
  try {
    const auto now = directory_.resources().clock.now();
    if (auto excess = client.meter()->count_bytes(message.size(), now)) {
      return refuse(client, id, {}, *excess);
    }
    auto request = read(message, sender.role, id);
    if (auto excess = client.meter()->count(class_of(request), now)) {
      const auto* good = std::get_if<RpcRequest>(&request);
      return refuse(client, id, good == nullptr ? std::string_view() : good->method, *excess);
    }
    if (auto* error = std::get_if<RpcError>(&request)) {
      client.send(write_reply(id.value_or(nullptr), std::move(*error)));
      return;
    }
    if (forward(sender, std::get<RpcRequest>(request), id, message)) return;
    PendingReply reply(sender.outbox, id, &directory_.resources().metrics);
    if (!id) reply.set_notification(std::get<RpcRequest>(request).method);
    if (auto result =
            call(reply, sender, std::get<RpcRequest>(std::move(request)), message.size())) {
      reply.answer(*std::move(result));
    }
  } catch (const StorageError& error) {
    log_error("a message failed: {}", error.what());
    client.send(write_reply(id.value_or(nullptr), storage_failed(error.kind())));
  } catch (const std::exception& error) {
    log_error("a message failed: {}", error.what());
    client.send(write_reply(id.value_or(nullptr), internal_error()));
  }
}

bool Dispatcher::forward(const SessionDirectory::Sender& sender, const RpcRequest& request,
                         const std::optional<Json>& id, std::string_view message) {
  if (sender.relay == nullptr || !is_for_owner(request, sender.relay->place().session)) {
    return false;
  }
  RelayedClient::NoteResult note;
  if (request.method == "replay.open") note = directory_.note_replay_of(sender.outbox->id());
  return sender.relay->forward(message, id, std::move(note));
}

void Dispatcher::receive_binary(ClientOutbox& client, std::size_t bytes) {
  VAT_CHECK(client.meter() != nullptr);
  const auto now = directory_.resources().clock.now();
  auto excess = client.meter()->count_bytes(bytes, now);
  if (!excess) excess = client.meter()->count(RateClass::query, now);
  if (excess) return refuse(client, {}, {}, *excess);
  client.send(write_reply(nullptr, invalid_request("only the server sends binary messages")));
}

void Dispatcher::refuse(ClientOutbox& client, const std::optional<Json>& id,
                        std::string_view method, const RateExcess& excess) {
  directory_.resources().metrics.add_rate_limited(excess.limit);
  if (excess.is_flood) return client.close(kFlooding, "too many messages");
  const RpcError error = rate_limited(excess.limit, excess.maximum, excess.retry_after.count());
  if (id) {
    client.send(write_reply(*id, error));
  } else if (!method.empty()) {
    client.report_rejected(method, error);
  }
}

std::variant<RpcRequest, RpcError> Dispatcher::read(std::string_view message, Role role,
                                                    std::optional<Json>& id) const {
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

std::optional<RpcError> Dispatcher::refuse_for_memory(const MethodRow& row) const {
  // The other methods need little memory, and some of them release memory.
  if (row.rate_class != RateClass::scene && row.rate_class != RateClass::read) return {};
  const auto excess = directory_.resources().memory.find_excess();
  if (!excess) return {};
  return limit_reached(*excess);
}

std::optional<RpcResult> Dispatcher::call_frames(PendingReply& reply, RelayedClient& relay,
                                                 const RpcRequest& request) {
  Errors errors;
  ObjectReader params(request.params, "", errors);
  const bool subscribes = request.method == "frames.subscribe";
  const Subscription wanted = subscribes ? read_subscription(params, errors) : Subscription{};
  params.refuse_unknown();
  if (!errors.empty()) return invalid_params(errors);
  if (subscribes) {
    relay.subscribe(std::move(reply), wanted);
  } else {
    relay.unsubscribe(std::move(reply));
  }
  return {};
}

std::optional<RpcResult> Dispatcher::call(PendingReply& reply,
                                          const SessionDirectory::Sender& sender,
                                          RpcRequest request, std::size_t bytes) {
  const Role role = sender.role;
  const Method* method = find_method(request.method);
  if (role == Role::none && (method == nullptr || method->row.least_role > Role::none)) {
    return not_authenticated("the first message must be access.enter");
  }
  if (method == nullptr) return unknown_method(request.method);
  const MethodRow& row = method->row;
  reply.set_method(row);
  if (row.rate_class != RateClass::scene && bytes > limits().max_message_bytes) {
    return limit_reached("message_bytes", limits().max_message_bytes);
  }
  if (auto error = refuse_for_memory(row)) return *std::move(error);
  if (auto error =
          reply.count(bytes, limits().max_commands_in_flight, limits().max_bytes_in_flight)) {
    return *std::move(error);
  }
  if (const auto* handler = std::get_if<ServerHandler>(&method->handler)) {
    if (row.role_source == RoleSource::connection) {
      if (auto error = refuse_role(row, role)) return *std::move(error);
    }
    if (names_session(row) && directory_.ask_owner(reply, request)) return {};
    Errors errors;
    ObjectReader params(request.params, "", errors);
    const ServerAction action = (*handler)(params, errors);
    params.refuse_unknown();
    if (!errors.empty()) return invalid_params(errors);
    VAT_CHECK(action != nullptr);
    return action(directory_, reply);
  }
  if (sender.relay != nullptr && controls_frames(row.name)) {
    return call_frames(reply, *sender.relay, request);
  }
  auto command = session_methods().parse(row.name, std::move(request.params));
  if (const auto* errors = std::get_if<Errors>(&command)) return invalid_params(*errors);
  if (auto error = directory_.post(reply, std::get<SessionCommand>(std::move(command)))) {
    return *std::move(error);
  }
  return {};
}

}  // namespace vat
