#include "server/rpc/session_server.h"

#include <exception>
#include <memory>
#include <utility>

#include "server/relay/relay_downloads.h"
#include "server/relay/relay_host.h"
#include "server/rpc/dispatcher.h"
#include "server/rpc/method_table.h"
#include "server/support/log.h"

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
  std::shared_ptr<RelayHost> relay;                 // null: this server is no node of a cluster
  std::unique_ptr<RelayDownloads> relay_downloads;  // null: as above
};

SessionServer::SessionServer(const Catalogue& catalogue, ServerSettings settings, Clock& clock)
    : parts_(new Parts{.directory{catalogue, std::move(settings), clock, session_methods()},
                       .relay = nullptr,
                       .relay_downloads = nullptr}) {
  SessionDirectory& directory = parts_->directory;
  ClusterNode* const cluster = directory.resources().cluster.get();
  if (cluster == nullptr) return;
  RelayHost::Server server{
      *this,
      [&directory](std::shared_ptr<Connection> connection, const Grant& access, bool is_open) {
        const bool needs_token = directory.resources().settings.access.mode == AccessMode::token;
        if (is_open && needs_token) return false;  // the other node has checked nothing
        return directory.connect(std::move(connection), access);
      },
      [&directory](const std::shared_ptr<ClientOutbox>& viewer, const std::string& session,
                   const Subscription& wanted) { return directory.watch(viewer, session, wanted); },
      [&directory](const std::string& session, std::shared_ptr<ClientOutbox> viewer) {
        directory.unwatch(session, std::move(viewer));
      },
      *cluster};
  parts_->relay = std::make_shared<RelayHost>(cluster->name(), cluster->relay_connection(),
                                              std::move(server), clock);
  parts_->relay_downloads = std::make_unique<RelayDownloads>(
      cluster->name(), cluster->relay_connection(), directory.resources().downloads, clock);
  directory.on_cluster_change([weak = std::weak_ptr(parts_->relay), cluster] {
    const auto relay = weak.lock();
    if (relay == nullptr) return;
    relay->look([cluster](const std::string& node) { return cluster->is_present(node); });
  });
}

SessionServer::~SessionServer() {
  try {
    stop();  // first, because threads of the directory call the relay
  } catch (const std::exception& error) {
    log_error("the server did not stop in order: {}", error.what());
  }
}

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

bool SessionServer::is_replaced() const {
  return parts_->directory.is_replaced();
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

HttpHandler SessionServer::serve_downloads(HttpHandler site) {
  RelayDownloads* const others = parts_->relay_downloads.get();
  FetchDownload fetch;
  if (others != nullptr) {
    fetch = [others](const std::string& node, const std::string& path,
                     std::function<void(HttpResponse)> answer) {
      others->fetch(node, path, std::move(answer));
    };
  }
  return with_downloads(std::move(site), downloads(), parts_->directory.resources().clock,
                        std::move(fetch));
}

void SessionServer::count_refusal(std::string_view limit) {
  parts_->directory.resources().metrics.add_refusal(limit);
}

void SessionServer::count_close(std::uint16_t code) {
  parts_->directory.resources().metrics.add_close(code);
}

void SessionServer::stop() {
  parts_->directory.stop();
  if (parts_->relay != nullptr) parts_->relay->stop();
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
