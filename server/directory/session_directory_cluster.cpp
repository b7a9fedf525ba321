// Sessions of a cluster, for a server that is one of its nodes.

#include <boost/asio/post.hpp>
#include <stdexcept>
#include <utility>

#include "core/support/check.h"
#include "server/directory/session_directory.h"
#include "server/session/core/scene_loading.h"
#include "server/support/log.h"

namespace vat {
namespace {

std::string write_answer(const RpcResult& result) {
  if (const auto* error = std::get_if<RpcError>(&result)) {
    return Json{
        {"kind", static_cast<int>(error->kind)}, {"message", error->message}, {"data", error->data}}
        .dump();
  }
  return Json{{"result", std::get<Json>(result)}}.dump();
}

RpcResult read_create_answer(const std::string& text) {
  const Json answer = Json::parse(text);
  if (answer.contains("result")) return answer.at("result");
  const auto kind = answer.at("kind").get<std::size_t>();
  if (kind >= error_rows().size()) return internal_error();
  return RpcError{static_cast<ErrorKind>(kind), answer.at("message"), answer.at("data")};
}

}  // namespace

std::size_t SessionDirectory::recover() {
  if (resources_.cluster == nullptr) return recoverer_.start();
  return resources_.cluster->start(*this);
}

bool SessionDirectory::is_replaced() const {
  return resources_.cluster != nullptr && !resources_.cluster->has_name();
}

void SessionDirectory::start_taken(const StoredSession& session) {
  recoverer_.start(session);
}

void SessionDirectory::tell_moved(SessionNumber number, const std::string& url) {
  VAT_CHECK(tables_.mutex.is_held());
  const std::string moved =
      write_event("session.moved", {{"session", to_id(number)}, {"url", url}});
  tables_.clients.close_session(number, moved, moved);
}

void SessionDirectory::end_lost(std::uint64_t session, const std::string& url,
                                std::function<void()> done) {
  std::vector<AbsentSession::Waiting> waiting;
  {
    const std::lock_guard lock(tables_.mutex);
    if (admission_.stopped()) return done();
    tell_moved(session, url);
    if (tables_.sessions.running().contains(session)) {
      tables_.sessions.at(session).close(Session::End::moved, {});
      tables_.sessions.remove(session);
    } else if (tables_.sessions.absent().contains(session)) {
      waiting = std::move(tables_.sessions.absent_at(session).waiting);
      tables_.sessions.remove_absent(session);
    }
    remove_tokens(to_id(session), Session::End::resumable);
  }
  for (AbsentSession::Waiting& one : waiting) one.reply.answer(moved_to(to_id(session), url));
  resources_.storage->journal().post(
      [&storage = *resources_.storage, session] { storage.sessions().close(session); },
      [&storage = *resources_.storage, done = std::move(done)](auto) {
        storage.remove_closed();
        done();
      });
  log_info("session {} is on another node: {}", to_id(session), url);
}

bool SessionDirectory::stop_for_move(std::uint64_t session, std::function<void()> done) {
  const std::lock_guard lock(tables_.mutex);
  if (!tables_.sessions.running().contains(session)) return false;
  tables_.sessions.at(session).hand_over(std::move(done));
  return true;
}

void SessionDirectory::create_for(const std::string& request,
                                  std::function<void(const std::string&)> answer) {
  boost::asio::post(resources_.creations, [this, request, answer = std::move(answer)] {
    RpcResult result = internal_error();
    try {
      const Json json = Json::parse(request);
      const auto level = find_level(json.at("level").get<std::string>());
      if (!level) throw std::invalid_argument("unknown level");
      auto read = read_named_scene(json.at("scene"), *level, resources_.environment);
      if (auto* error = std::get_if<RpcError>(&read)) {
        result = std::move(*error);
      } else {
        auto created = create(json.at("name"), std::get<Scene>(read), {});
        if (const auto* id = std::get_if<SessionId>(&created)) return answer_created(*id, answer);
        result = std::get<RpcError>(std::move(created));
      }
    } catch (const std::exception& error) {
      log_error("a session for another node is not created: {}", error.what());
    }
    answer(write_answer(result));
  });
}

void SessionDirectory::answer_created(const SessionId& id,
                                      const std::function<void(const std::string&)>& answer) {
  const auto time = resources_.settings.access.ticket_time;
  resources_.tokens.issue({Role::owner, id, true}, 1, time,
                          [id, answer](const AccessTokens::Issued& issued) {
                            Json result{{"session", id}, {"tick", 0}};
                            if (issued.token) result["ticket"] = *issued.token;
                            answer(write_answer(result));
                          });
}

std::optional<RpcResult> SessionDirectory::create_elsewhere(const Json& scene, Level level,
                                                            const std::string& name) {
  if (resources_.cluster == nullptr) return {};
  const std::string node = resources_.cluster->best_node();
  if (node == resources_.cluster->name()) return {};
  Json content = scene;  // a saved scene has no name on the other node
  if (scene.is_string() && !resources_.catalogue.find(scene.get_ref<const std::string&>())) {
    auto saved = find_saved_scene(scene.get_ref<const std::string&>(), resources_.environment);
    if (auto* error = std::get_if<RpcError>(&saved)) return *std::move(error);
    content = std::get<Json>(std::move(saved));
  }
  const Json request{{"name", name}, {"scene", std::move(content)}, {"level", to_string(level)}};
  try {
    return read_create_answer(resources_.cluster->create_at(node, request.dump()));
  } catch (const std::exception& error) {
    log_warning("the node {} creates no session: {}", node, error.what());
    return {};
  }
}

std::optional<LocatedSession> SessionDirectory::find_elsewhere(
    const std::optional<SessionId>& id) const {
  if (resources_.cluster == nullptr) return {};
  if (id) {
    const auto number = number_of(*id);
    return number ? resources_.cluster->find(*number) : std::nullopt;
  }
  const std::vector<LocatedSession> all = resources_.cluster->sessions();
  if (all.empty()) return {};
  return all.front();
}

std::optional<RpcError> SessionDirectory::join_elsewhere(PendingReply& reply,
                                                         const std::optional<SessionId>& id,
                                                         JoinRequest& request, bool& is_missing) {
  VAT_CHECK(tables_.mutex.is_held());
  const auto located = find_elsewhere(id);
  is_missing = !located;
  if (!located) return {};
  Client* const client = tables_.clients.find(reply);
  VAT_CHECK(client != nullptr);
  if (auto error = admission_.refuse_access(*client, located->number)) return error;
  if (located->owner != resources_.cluster->name()) {
    const auto url = resources_.cluster->url_of(*located);
    const bool relays = resources_.relay != nullptr && !client->is_relayed;
    if (url && !relays) return moved_to(to_id(located->number), *url);
    if (url && can_relay(*located)) {
      join_by_relay(*client, reply, *located, request);
      return {};
    }
  }
  waiting_joins_.push_back({to_id(located->number), {std::move(reply), std::move(request)}});
  return {};
}

bool SessionDirectory::wait_for_replay(PendingReply& reply, const std::optional<SessionId>& id,
                                       JoinRequest& request) {
  VAT_CHECK(tables_.mutex.is_held());
  if (resources_.cluster == nullptr || !id || number_of(*id).value_or(0) < kFirstReplay) {
    return false;
  }
  resources_.cluster->refresh_replays([this, id, request = std::move(request),
                                       waiting = std::make_shared<PendingReply>(std::move(reply))] {
    if (auto error = join_or_wait(*waiting, id, request, false)) {
      waiting->answer(*std::move(error));
    }
  });
  return true;
}

std::map<std::uint64_t, std::string> SessionDirectory::replays() const {
  const std::lock_guard lock(tables_.mutex);
  std::map<std::uint64_t, std::string> replays;
  const auto& running = tables_.sessions.running();
  for (auto replay = running.lower_bound(kFirstReplay); replay != running.end(); ++replay) {
    replays[replay->first] = replay->second->summary().name;
  }
  return replays;
}

void SessionDirectory::cluster_changed() {
  if (cluster_change_) cluster_change_();
  if (resources_.relay != nullptr) {
    resources_.relay->look([this](const SessionId& id) { return present_owner(id); },
                           resources_.settings.limits.frame_patience);
  }
  std::vector<WaitingJoin> waiting;
  {
    const std::lock_guard lock(tables_.mutex);
    waiting.swap(waiting_joins_);
  }
  for (WaitingJoin& one : waiting) {
    if (auto error = join(one.join.reply, one.id, std::move(one.join.request))) {
      one.join.reply.answer(*std::move(error));
    }
  }
}

std::map<std::uint64_t, std::string> SessionDirectory::describe_sessions() const {
  std::map<std::uint64_t, std::string> descriptions;
  const std::lock_guard lock(tables_.mutex);
  for (const auto& [number, session] : tables_.sessions.running()) {
    const ListedSession listed{to_id(number), session->summary(), "running", false,
                               resources_.cluster->name()};
    Json description = describe_session(listed);
    add_people(description, listed.summary);
    descriptions[number] = description.dump();
  }
  return descriptions;
}

void SessionDirectory::describe_elsewhere(
    std::function<void(const std::map<SessionId, Json>&)> done) {
  VAT_CHECK(resources_.cluster != nullptr);
  resources_.cluster->describe_sessions(
      [done = std::move(done)](const ClusterNode::Descriptions& texts) {
        std::map<SessionId, Json> descriptions;
        for (const auto& [number, text] : texts) descriptions[to_id(number)] = Json::parse(text);
        done(descriptions);
      });
}

void SessionDirectory::add_elsewhere(const Client& client, std::vector<ListedSession>& list) const {
  VAT_CHECK(tables_.mutex.is_held());
  if (resources_.cluster == nullptr) return;
  std::vector<LocatedSession> all = resources_.cluster->sessions();
  for (LocatedSession& replay : resources_.cluster->replays()) all.push_back(std::move(replay));
  for (const LocatedSession& one : all) {
    const bool is_here = tables_.sessions.running().contains(one.number) ||
                         tables_.sessions.absent().contains(one.number);
    if (is_here || admission_.refuse_access(client, one.number)) continue;
    SessionSummary summary;
    summary.name = one.name;
    summary.is_replay = one.number >= kFirstReplay;
    list.push_back({to_id(one.number), std::move(summary), "elsewhere", false, one.owner});
  }
}

std::optional<RpcError> SessionDirectory::move(PendingReply& reply, const SessionId& id,
                                               const std::string& node) {
  if (resources_.cluster == nullptr) return not_allowed("the server is no node of a cluster");
  const auto number = number_of(id);
  if (number && *number >= kFirstReplay) {
    const std::lock_guard lock(tables_.mutex);
    if (tables_.sessions.find(id) == nullptr) return no_such_session(id, "/session");
    return not_allowed("a replay stays on its node");
  }
  const auto waiting = std::make_shared<PendingReply>(std::move(reply));
  const auto answer = [waiting, id](const std::optional<std::string>& url) {
    if (!url) return waiting->answer(not_recovered(id, "recovering"));
    waiting->answer(Json{{"session", id}, {"url", *url}});
  };
  using Refusal = ClusterNode::MoveRefusal;
  const auto refusal =
      number ? resources_.cluster->move(*number, node, answer) : std::optional(Refusal::not_owned);
  if (!refusal) return {};
  reply = std::move(*waiting);
  switch (*refusal) {
    case Refusal::not_present:
      return invalid_params({Error{"bad_value", "/node", "must be another running node"}});
    case Refusal::lacks_instructions:
      return invalid_params(
          {Error{"bad_value", "/node", "must be a node that has the session's instruction set"}});
    case Refusal::is_moving:
      return invalid_params(
          {Error{"bad_value", "/node", "must be the node to which the session is moving"}});
    case Refusal::not_owned:
      break;
  }
  const auto elsewhere = number ? resources_.cluster->find(*number) : std::nullopt;
  if (!elsewhere) return no_such_session(id, "/session");
  if (elsewhere->owner == resources_.cluster->name()) return not_recovered(id, "recovering");
  return moved_to(id, resources_.cluster->url_of(*elsewhere).value_or(""));
}

}  // namespace vat
