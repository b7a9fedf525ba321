// Questions of a node to all other nodes, and the answers.

#include <cstdlib>
#include <exception>
#include <utility>

#include "protocol/json/json_reader.h"
#include "server/cluster/cluster_node.h"
#include "server/support/log.h"

namespace vat {
namespace {

constexpr const char* kReplaysQuestion = "replays";
constexpr const char* kSessionsQuestion = "sessions after ";  // and a number
constexpr std::size_t kAnswerBytes = 256 * 1024;              // a message of NATS has at most 1 MB

std::uint64_t number_after(const std::string& question) {
  return std::strtoull(question.c_str() + std::string_view(kSessionsQuestion).size(), nullptr, 10);
}

/// Returns the descriptions after this number, up to about kAnswerBytes.
std::string write_descriptions(const std::map<std::uint64_t, std::string>& all,
                               std::uint64_t after) {
  Json sessions = Json::array();
  std::size_t bytes = 0;
  auto next = all.upper_bound(after);
  for (; next != all.end() && bytes < kAnswerBytes; ++next) {
    sessions.push_back({{"number", next->first}, {"text", next->second}});
    bytes += next->second.size();
  }
  return Json{{"sessions", std::move(sessions)}, {"more", next != all.end()}}.dump();
}

}  // namespace

/// Questions that are asked at the same time.
struct ClusterNode::Questions {
  /// Called with each answer, by one thread at a time. Returns the next question to the node, or
  /// nothing. Throws an exception if the answer is invalid.
  std::function<std::optional<std::string>(const std::string& node, const std::string& answer)>
      receive;
  std::function<void()> done;
  std::mutex mutex;      // guards `left`, and calls of `receive`
  std::size_t left = 1;  // nodes, and ask_all() until it has asked all
};

void ClusterNode::ask_all(std::shared_ptr<Questions> questions, const std::string& question) {
  for (const NodeInfo& node : nodes_.seen_within(Lease::kOthersTime)) {
    if (node.name == name()) continue;
    {
      const std::lock_guard lock(questions->mutex);
      ++questions->left;
    }
    ask(questions, node.name, question);
  }
  const std::lock_guard lock(questions->mutex);
  if (--questions->left == 0) post(questions->done);
}

void ClusterNode::ask(const std::shared_ptr<Questions>& questions, const std::string& node,
                      const std::string& question) {
  connection_.request(question_subject(node), {}, question,
                      settings_.answer_time.value_or(entry_age()),
                      [this, questions, node](const NatsConnection::Result& result) {
                        std::optional<std::string> next;
                        {
                          const std::lock_guard lock(questions->mutex);
                          try {
                            const auto* answer = std::get_if<NatsMessage>(&result);
                            if (answer != nullptr) next = questions->receive(node, answer->data);
                          } catch (const std::exception& error) {
                            log_warning("the answer of the node {}: {}", node, error.what());
                          }
                          if (!next && --questions->left == 0) post(questions->done);
                        }
                        if (next) ask(questions, node, *next);
                      });
}

void ClusterNode::refresh_replays(std::function<void()> done) {
  {
    const std::lock_guard lock(mutex_);
    wait_for_replays_.push_back(std::move(done));
    if (std::exchange(asks_for_replays_, true)) return;
  }
  ask_for_replays();
}

void ClusterNode::ask_for_replays() {
  const auto questions = std::make_shared<Questions>();
  questions->receive = [this](const std::string& node, const std::string& answer) {
    if (auto info = read_node(node, answer)) nodes_.note_replays(node, std::move(info->replays));
    return std::optional<std::string>();
  };
  std::vector<std::function<void()>> waiting;
  {
    const std::lock_guard lock(mutex_);
    waiting.swap(wait_for_replays_);
  }
  questions->done = [this, waiting = std::move(waiting)] {
    for (const auto& done : waiting) post(done);
    {
      const std::lock_guard lock(mutex_);
      asks_for_replays_ = !wait_for_replays_.empty();
      if (!asks_for_replays_) return;
    }
    ask_for_replays();
  };
  ask_all(questions, kReplaysQuestion);
}

void ClusterNode::describe_sessions(std::function<void(const Descriptions&)> done) {
  const auto all = std::make_shared<Descriptions>();
  const auto questions = std::make_shared<Questions>();
  questions->receive = [all](const std::string&,
                             const std::string& answer) -> std::optional<std::string> {
    const Json page = Json::parse(answer);
    std::uint64_t last = 0;
    for (const Json& session : page.at("sessions")) {
      last = session.at("number");
      (*all)[last] = session.at("text");
    }
    if (last == 0 || !page.at("more").get<bool>()) return {};
    return kSessionsQuestion + std::to_string(last);
  };
  questions->done = [all, done = std::move(done)] { done(*all); };
  ask_all(questions, kSessionsQuestion + std::to_string(0));
}

std::string ClusterNode::answer_to(const std::string& question) const {
  if (question == kReplaysQuestion) return write_node(describe());
  if (question.starts_with(kSessionsQuestion)) {
    return write_descriptions(host_->describe_sessions(), number_after(question));
  }
  return "{}";
}

void ClusterNode::answer(const NatsMessage& question) {
  if (question.reply_to.empty()) return;
  try {
    connection_.publish(question.reply_to, answer_to(question.data));
  } catch (const NatsError& error) {
    log_warning("an answer to another node: {}", error.what());
  }
}

}  // namespace vat
