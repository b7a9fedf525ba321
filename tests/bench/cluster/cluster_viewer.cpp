#include "tests/bench/cluster/cluster_viewer.h"

#include <span>
#include <stdexcept>
#include <thread>

#include "protocol/frame/frame_codec.h"
#include "tests/bench/soak/caller.h"

namespace vat::bench {
namespace {

using std::chrono::steady_clock;

constexpr std::chrono::milliseconds kRetryTime(50);
constexpr std::chrono::seconds kSilence(2);  // a longer one means that the node has ended
constexpr std::chrono::minutes kClusterPatience{1};

}  // namespace

void ClusterViewer::join(std::size_t node) {
  const auto deadline = steady_clock::now() + kClusterPatience;
  while (!try_join(node)) {
    if (steady_clock::now() > deadline) throw std::runtime_error("no node has the session");
    std::this_thread::sleep_for(kRetryTime);
  }
}

void ClusterViewer::follow() {
  std::size_t next = (node_ + 1) % nodes_.size();
  try {
    read(steady_clock::now() + kSilence);
    if (!is_moved_) return;
    next = nodes_.node_at(moved_to_);
  } catch (const std::runtime_error&) {  // the node has ended
  }
  join(next);
}

void ClusterViewer::play(std::chrono::milliseconds time) {
  const auto end = steady_clock::now() + time;
  while (steady_clock::now() < end && !is_moved_) {
    const double g = -9 - 1e-3 * static_cast<double>(++commands_ % 100);
    call("world.set_gravity", {{"gravity", {0, 0, g}}});
  }
}

std::size_t ClusterViewer::wait_for_move() {
  const auto deadline = steady_clock::now() + kClusterPatience;
  while (!is_moved_) read(deadline);
  return nodes_.node_at(moved_to_);
}

bool ClusterViewer::try_join(std::size_t& node) {
  is_moved_ = false;
  try {
    connection_ = connect(nodes_.port(node));
    Json params{{"session", "s1"}};
    if (!resume_.empty()) params["resume"] = resume_;
    const Json reply = send("session.join", params);
    if (reply.contains("result")) {
      const Json& joined = reply.at("result");
      if (!resume_.empty() && joined.at("resumed") != true) {
        throw std::logic_error("the participant was lost");
      }
      resume_ = joined.at("resume");
      node_ = node;
      call("frames.subscribe", Json::object());
      const auto before = last_frame_;
      while (last_frame_ == before && !is_moved_) read(steady_clock::now() + kSilence);
    }
    if (is_moved_) node = nodes_.node_at(moved_to_);
    if (is_moved_ || reply.contains("result")) return !is_moved_;
    const std::string to = reply.at("error").at("data").value("url", "");
    if (!to.empty()) node = nodes_.node_at(to);
  } catch (const std::runtime_error&) {  // the node has ended
    node = (node + 1) % nodes_.size();
  }
  return false;
}

void ClusterViewer::call(const std::string& method, const Json& params) {
  const Json reply = send(method, params);
  if (!is_moved_ && !reply.contains("result")) throw std::runtime_error(reply.dump());
}

Json ClusterViewer::send(const std::string& method, const Json& params) {
  connection_->send_text(
      Json{{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", params}}.dump());
  const auto deadline = steady_clock::now() + kClusterPatience;
  for (;;) {
    const auto reply = read(deadline);
    if (is_moved_ || (reply && reply->value("id", Json()) == id_)) return reply.value_or(Json());
  }
}

std::optional<Json> ClusterViewer::read(steady_clock::time_point deadline) {
  const auto message = connection_->next(deadline);
  if (!message || message->kind == client::Message::Kind::closed) {
    throw std::runtime_error("the connection has ended");
  }
  if (message->kind == client::Message::Kind::text) {
    Json text = Json::parse(message->bytes);
    if (text.value("method", "") == "session.moved") {
      is_moved_ = true;
      moved_to_ = text.at("params").at("url");
    }
    return text;
  }
  last_frame_ = steady_clock::now();
  const std::span bytes(reinterpret_cast<const std::uint8_t*>(message->bytes.data()),
                        message->bytes.size());
  connection_->send_text(Json{
      {"jsonrpc", "2.0"}, {"method", "frames.ack"}, {"params", {{"number", frame_number(bytes)}}}}
                             .dump());
  return {};
}

}  // namespace vat::bench
