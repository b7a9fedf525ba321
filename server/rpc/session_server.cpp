#include "server/rpc/session_server.h"

#include <utility>

#include "server/rpc/dispatcher.h"

namespace vat {
namespace {

constexpr std::uint16_t kTooManyConnections = 1013;

Errors to_errors(const RpcError& error) {
  Errors errors;
  if (const auto list = error.data.find("errors"); list != error.data.end()) {
    for (const Json& entry : *list) {
      errors.push_back({entry.at("code"), entry.at("path"), entry.at("message"),
                        entry.value("suggestion", std::string())});
    }
  }
  if (errors.empty()) {
    errors.push_back({std::string(error_row(error.kind).name), "", error.message});
  }
  return errors;
}

}  // namespace

struct SessionServer::Parts {
  SessionDirectory directory;
  Dispatcher dispatcher{directory};
};

SessionServer::SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock)
    : parts_(new Parts{.directory{catalogue, std::move(settings), clock, session_methods()}}) {}

SessionServer::~SessionServer() = default;

Result<SessionId> SessionServer::create_session(std::string name, const Scene& scene) {
  auto created = parts_->directory.create(std::move(name), scene, {});
  if (const auto* error = std::get_if<RpcError>(&created)) return to_errors(*error);
  return std::get<SessionId>(std::move(created));
}

std::size_t SessionServer::recover() {
  return parts_->directory.recover();
}

bool SessionServer::is_ready() const {
  return parts_->directory.is_ready();
}

std::string SessionServer::metrics() const {
  return parts_->directory.metrics();
}

std::string SessionServer::slow_ticks() const {
  return parts_->directory.resources().metrics.slow_ticks().trace();
}

std::string SessionServer::health() const {
  return parts_->directory.health().dump();
}

void SessionServer::drain(std::chrono::milliseconds time) {
  parts_->directory.drain(time);
}

void SessionServer::flush() {
  parts_->directory.flush();
}

Downloads& SessionServer::downloads() {
  return parts_->directory.resources().downloads;
}

void SessionServer::count_refusal(std::string_view limit) {
  parts_->directory.resources().metrics.add_refusal(limit);
}

void SessionServer::count_close(std::uint16_t code) {
  parts_->directory.resources().metrics.add_close(code);
}

void SessionServer::stop() {
  parts_->directory.stop();
}

void SessionServer::opened(std::shared_ptr<Connection> connection) {
  if (!parts_->directory.connect(connection)) {
    connection->close(kTooManyConnections, "too many connections");
  }
}

void SessionServer::text_received(ConnectionId id, std::string_view message) {
  const SessionDirectory::Sender sender = parts_->directory.find_client(id);
  if (sender.outbox != nullptr) parts_->dispatcher.receive(sender, message);
}

void SessionServer::binary_received(ConnectionId id, std::string_view message) {
  const SessionDirectory::Sender sender = parts_->directory.find_client(id);
  if (sender.outbox != nullptr) parts_->dispatcher.receive_binary(*sender.outbox, message.size());
}

void SessionServer::closed(ConnectionId id) {
  parts_->directory.disconnect(id);
}

}  // namespace vat
