#include "server/relay/relay_host.h"

#include <boost/asio/post.hpp>
#include <stdexcept>
#include <utility>
#include <vector>

#include "server/relay/relay_door.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr std::uint16_t kNoRoom = 1013;
constexpr std::uint16_t kGoingAwayCode = 1001;
constexpr std::chrono::seconds kHostLookInterval(1);
/// A relay sends a message on each link more often.
constexpr std::chrono::seconds kRelaySilence(15);
/// The transport uses lower numbers.
constexpr ConnectionId kFirstRelayed = ConnectionId{1} << 62;

Subscription read_wish(const Json& fields) {
  Subscription wanted;
  wanted.max_error = 0;
  wanted.keeps_precision = true;
  wanted.attribute_errors = fields.at("attributes").get<ByAttribute<double>>();
  return wanted;
}

/// Throws std::out_of_range for a role that does not exist.
Grant read_grant(const Json& access) {
  const auto role = access.at("role").get<std::size_t>();
  if (role >= kNamesOf<Role>.size()) throw std::out_of_range("role " + std::to_string(role));
  return {static_cast<Role>(role), access.at("session"), access.at("is_invitation")};
}

}  // namespace

RelayHost::RelayHost(std::string node, NatsConnection& connection, Server server,
                     const Clock& clock)
    : node_(std::move(node)),
      connection_(connection),
      server_(std::move(server)),
      clock_(clock),
      last_id_(kFirstRelayed) {
  boost::asio::post(thread_, [] { pthread_setname_np(pthread_self(), "vat-relay"); });
  subscription_ =
      connection_.subscribe(RelayDoor::owner_subject(node_), [this](const NatsMessage& message) {
        boost::asio::post(thread_, [this, bytes = message.data] { receive(bytes); });
      });
}

RelayHost::~RelayHost() {
  stop();
}

void RelayHost::stop() {
  subscription_.reset();
  thread_.join();
}

void RelayHost::look(std::function<bool(const std::string&)> is_present) {
  boost::asio::post(thread_, [this, is_present = std::move(is_present)] {
    const auto now = clock_.now();
    if (now - looked_ < kHostLookInterval) return;
    looked_ = now;
    for (const auto& [name, link] : links_) {
      const std::string relay = name.substr(0, name.find('.'));
      if (now - link.heard <= kRelaySilence && is_present(relay)) continue;
      link.connection->close(kGoingAwayCode, "the relay is silent");
    }
  });
}

void RelayHost::receive(const std::string& bytes) {
  auto message = read_relay_message(bytes);
  if (!message) return;
  try {
    const auto found = links_.find(message->link);
    if (found == links_.end()) {
      if (message->number != 1) return refuse(*message);
      if (message->kind == RelayKind::open) return open(*message);
      if (message->kind == RelayKind::watch) return watch(*message);
      return refuse(*message);
    }
    Link& link = found->second;
    link.heard = clock_.now();
    switch (link.received.take(*message)) {
      case RelayInput::Taken::part:
        return;
      case RelayInput::Taken::lost:
        return link.connection->close(kGoingAwayCode, "a message was lost");
      case RelayInput::Taken::whole:
        break;
    }
    switch (message->kind) {
      case RelayKind::text:
        if (link.viewer == nullptr) {
          server_.clients.text_received(link.connection->id(), message->body);
        }
        return;
      case RelayKind::watch:
        return watch(*message);
      case RelayKind::ack:
        return acknowledge(link, *message);
      case RelayKind::alive:
        link.line->send(RelayKind::alive);
        return;
      case RelayKind::end:
        link.connection->abandon();
        return remove(found);
      case RelayKind::open:
      case RelayKind::frame:
        return;
    }
  } catch (const std::exception& error) {
    log_warning("relay: {}", error.what());
  }
}

void RelayHost::refuse(const RelayMessage& message) {
  if (message.kind == RelayKind::end) return;
  const Json& fields = message.fields;
  // The number of the first message tells the relay that messages were lost.
  RelayLine line(connection_, fields.value("subject", RelayDoor::client_subject(message.link)),
                 message.link);
  line.send(RelayKind::end, {{"code", kGoingAwayCode}});
}

RelayHost::Link& RelayHost::add(RelayMessage message) {
  const Json& fields = message.fields;
  const auto line = std::make_shared<RelayLine>(connection_, fields.at("subject"), message.link);
  auto connection = std::make_shared<RelayedConnection>(
      ++last_id_, fields.value("address", ""), line,
      [this, link = message.link] { boost::asio::post(thread_, [this, link] { remove(link); }); });
  Link& link = links_[message.link];
  link = {std::move(connection), line, {}, clock_.now(), "", nullptr};
  link.received.take(message);
  return link;
}

void RelayHost::open(const RelayMessage& message) {
  const Link& link = add(message);
  const Grant access = read_grant(message.fields.at("access"));
  if (server_.open(link.connection, access, message.fields.at("is_open"))) return;
  link.connection->close(kNoRoom, "too many connections");
}

void RelayHost::watch(const RelayMessage& message) {
  const auto known = links_.find(message.link);
  Link& link = known == links_.end() ? add(message) : known->second;
  if (link.viewer == nullptr) {
    link.session = message.fields.at("session");
    link.viewer = std::make_shared<ClientOutbox>(link.connection);
    link.viewer->set_gate(server_.gate);
  }
  if (server_.watch(link.viewer, link.session, read_wish(message.fields))) return;
  link.connection->close(kGoingAwayCode, "the session is not here");
}

void RelayHost::acknowledge(Link& link, const RelayMessage& message) {
  if (link.viewer == nullptr) return;
  link.viewer->acknowledge(message.fields.at("number"), clock_.now());
}

void RelayHost::remove(const std::string& link) {
  const auto found = links_.find(link);
  if (found != links_.end()) remove(found);
}

void RelayHost::remove(Links::iterator link) {
  const Link ended = std::move(link->second);
  links_.erase(link);
  ended.connection->abandon();
  if (ended.viewer == nullptr) return server_.clients.closed(ended.connection->id());
  server_.unwatch(ended.session, ended.viewer);
}

}  // namespace vat
