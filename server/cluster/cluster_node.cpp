// Life of a node, its lease, and the changes that it starts.

#include "server/cluster/cluster_node.h"

#include <sys/resource.h>

#include <algorithm>
#include <boost/asio/post.hpp>
#include <fstream>
#include <thread>
#include <utility>

#include "server/access/token.h"
#include "server/support/log.h"

namespace vat {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kTick(100);
constexpr milliseconds kRefresh(10'000);
constexpr milliseconds kClaimTime(20'000);
constexpr milliseconds kClaimInterval(100);
constexpr const char* kMarker = "cluster";

double processor_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto seconds = [](const timeval& time) {
    return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  };
  return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

NatsSettings nats_settings(const ClusterSettings& settings) {
  return {settings.servers,         "vat " + settings.node, settings.tls_ca,
          settings.tls_certificate, settings.tls_key,       settings.credentials};
}

}  // namespace

ClusterNode::ClusterNode(ClusterSettings settings, Storage& storage, Clock& clock, double cores,
                         const std::string& version)
    : settings_(std::move(settings)),
      storage_(storage),
      clock_(clock),
      cores_(cores),
      version_(version),
      instance_(make_token()),
      connection_(nats_settings(settings_)),
      relay_connection_(nats_settings(settings_)),
      lease_(clock),
      streams_(connection_),
      node_bucket_(connection_, "vat-nodes", settings_.entry_life.value_or(Lease::kOthersTime)),
      spare_bucket_(connection_, "vat-spare-nodes", Lease::kOthersTime),
      nodes_(clock),
      locator_(connection_),
      saved_(connection_, *this, clock_),
      saved_states_(saved_, [this](const std::string& session) { return has_session(session); }),
      saved_scenes_(saved_),
      tokens_(settings_.key.empty() ? nullptr
                                    : std::make_unique<ClusterTokens>(
                                          connection_, threads_.get_executor(), clock_, instance_)),
      timer_(clock.make_timer(timer_thread_.get_executor())) {
  check_data_folder();
}

ClusterNode::~ClusterNode() {
  stop();
}

void ClusterNode::check_data_folder() const {
  const std::string marker = storage_.folder() + "/" + kMarker;
  const bool is_marked = std::ifstream(marker).good();
  if (!is_marked && !storage_.sessions().sessions().empty()) {
    throw StorageError(StorageError::Kind::failed,
                       storage_.folder() +
                           " has the sessions of a server without a cluster; a "
                           "node needs a separate data folder");
  }
  std::ofstream(marker) << settings_.node << '\n';
}

std::size_t ClusterNode::start(ClusterHost& host) {
  host_ = &host;
  connection_.on_reconnect([this] { needs_refresh_ = true; });
  claim_name();
  listen();
  locator_.watch([this](const LocatedSession& changed) {
    boost::asio::post(timer_thread_, [this, number = changed.number] { look_at_change(number); });
  });
  connection_.flush(milliseconds(5000));
  for (const Bucket::Entry& entry : node_bucket_.all()) {
    if (auto node = read_node(entry.key, entry.value))
      nodes_.note(*std::move(node), entry.revision);
  }
  locator_.refresh();
  drop_foreign_sessions();
  boost::asio::post(timer_thread_, [this] { wait_for_tick(); });
  return locator_.all().size();
}

void ClusterNode::claim_name() {
  const auto end = clock_.now() + kClaimTime;
  std::uint64_t revision = 0;
  auto unchanged_since = clock_.now();
  for (;;) {
    const auto entry = node_bucket_.get(settings_.node);
    const auto now = clock_.now();
    if (entry && entry->revision != std::exchange(revision, entry->revision)) {
      unchanged_since = now;
    }
    if (!entry || now - unchanged_since >= Lease::kOthersTime) {
      try {
        NodeInfo node = describe();
        node.accepts = false;  // until the first renewal
        const std::string value = write_node(node);
        name_revision_ = entry ? node_bucket_.put(name(), value, entry->revision)
                               : node_bucket_.create(name(), value);
        return;
      } catch (const NatsError& error) {  // another process claims the name
        if (error.kind() != NatsError::Kind::conflict) throw;
      }
    }
    if (now > end) {
      throw NatsError(NatsError::Kind::refused,
                      "another running node has the name " + settings_.node);
    }
    std::this_thread::sleep_for(kClaimInterval);
  }
}

void ClusterNode::check_name() {
  try {
    const auto entry = node_bucket_.get(name());
    if (!entry) {
      name_revision_ = node_bucket_.create(name(), write_node(describe()));
      return;
    }
    const auto node = read_node(entry->key, entry->value);
    if (node && node->instance == instance_) {  // an unconfirmed renewal was stored
      name_revision_ = entry->revision;
    } else if (has_name_.exchange(false)) {
      log_error("another process is the node {}; this one serves no session any more", name());
    }
  } catch (const NatsError& error) {
    log_warning("the entry of the node {}: {}", name(), error.what());
  }
}

void ClusterNode::drop_foreign_sessions() {
  for (const StoredSession& stored : storage_.sessions().sessions()) {
    const auto entry = locator_.find(stored.number);
    if (!entry || entry->owner != name()) storage_.sessions().close(stored.number);
  }
  storage_.remove_closed();
}

void ClusterNode::listen() {
  subscriptions_.push_back(node_bucket_.watch([this](const Bucket::Entry& entry) {
    if (entry.is_removed) return nodes_.forget(entry.key);
    if (auto node = read_node(entry.key, entry.value))
      nodes_.note(*std::move(node), entry.revision);
  }));
  subscriptions_.push_back(spare_bucket_.watch([this](const Bucket::Entry& entry) {
    auto node = read_node(entry.key, entry.value);
    if (node) nodes_.note(*std::move(node), nodes_.revision_of(entry.key));
  }));
  subscriptions_.push_back(connection_.subscribe(
      question_subject(name()),
      [this](const NatsMessage& question) { post([this, question] { answer(question); }); }));
  subscriptions_.push_back(
      connection_.subscribe("vat.node." + name() + ".create", [this](const NatsMessage& request) {
        post([this, request] {
          host_->create_for(request.data,
                            [this, reply_to = request.reply_to](const std::string& answer) {
                              try {
                                if (!reply_to.empty()) connection_.publish(reply_to, answer);
                              } catch (const NatsError& error) {
                                log_warning("an answer to another node: {}", error.what());
                              }
                            });
        });
      }));
}

void ClusterNode::leave() {
  if (leaving_.exchange(true)) return;
  subscriptions_.clear();
  timer_thread_.join();
}

void ClusterNode::stop() {
  leave();
  if (stopped_.exchange(true)) return;
  lease_.end();
  {
    const std::lock_guard lock(mutex_);
    for (auto& [number, hosted] : hosted_) hosted.stream->end();
  }
  threads_.join();
  try {
    const auto entry = host_ == nullptr ? std::nullopt : node_bucket_.get(name());
    const auto node = entry ? read_node(entry->key, entry->value) : std::nullopt;
    const bool is_own = node && node->instance == instance_;
    if (is_own) node_bucket_.remove(entry->key, entry->revision);
  } catch (const NatsError& error) {
    log_warning("the node does not leave the cluster's list: {}", error.what());
  }
  relay_connection_.close();
  connection_.close();
}

NodeInfo ClusterNode::describe() const {
  return {name(),   instance_,      settings_.public_url,    to_string(best_instruction_set()),
          version_, cores_ - load_, !draining_ && !leaving_, host_->replays()};
}

void ClusterNode::post(std::function<void()> task) {
  boost::asio::post(threads_, [this, task = std::move(task)] {
    if (leaving_) return;
    try {
      task();
    } catch (const std::exception& error) {
      log_error("cluster: {}", error.what());
    }
  });
}

void ClusterNode::wait_for_tick() {
  if (leaving_) return;
  tick();
  timer_->start(clock_.now() + kTick, [this] { wait_for_tick(); });
}

void ClusterNode::tick() {
  const auto now = clock_.now();
  // The interval of a large cluster leaves no time for a second failure.
  if (!is_renewed_ || now - last_renewal_ >= renewal_.load()) renew(now);
  if (needs_refresh_.exchange(false) || now - last_refresh_ >= kRefresh) {
    last_refresh_ = now;
    post([this] { refresh(); });
  }
  if (lease_.is_valid()) look_at_sessions(now);
  host_->cluster_changed();
}

void ClusterNode::refresh() {
  try {
    locator_.refresh();
  } catch (const NatsError&) {
    needs_refresh_ = true;
    return;
  }
  try {
    separate_leaders();
  } catch (const NatsError& error) {  // the next refresh tries it again
    log_warning("the leaders of the streams are not separated: {}", error.what());
  }
}

void ClusterNode::measure_load(Time now) {
  const double seconds = processor_seconds();
  const double time = std::chrono::duration<double>(now - measured_at_).count();
  if (measured_at_ != Time() && time > 0) {
    load_ = load_ + ((seconds - measured_seconds_) / time - load_) / 4;
  }
  measured_at_ = now;
  measured_seconds_ = seconds;
}

void ClusterNode::renew(Time now) {
  last_renewal_ = now;
  renewal_ = Lease::renewal_interval(nodes_.seen_within(Lease::kOthersTime).size());
  measure_load(now);
  if (!has_name_ || renewing_.exchange(true)) return;
  const auto finish = [this, now](const Stream::Appended& result) {
    if (const auto* error = std::get_if<NatsError>(&result)) {
      if (error->kind() != NatsError::Kind::conflict) return renew_spare(now);
      return post([this, error = *error] {
        check_name();
        note_failed_renewal(error);
      });
    }
    name_revision_ = std::get<std::uint64_t>(result);
    note_renewal(now);
  };
  node_bucket_.put(name(), write_node(describe()), name_revision_, finish);
}

void ClusterNode::renew_spare(Time now) {
  spare_bucket_.put(name(), write_node(describe()), [this, now](const Stream::Appended& result) {
    if (const auto* error = std::get_if<NatsError>(&result)) return note_failed_renewal(*error);
    note_renewal(now);
  });
}

void ClusterNode::note_renewal(Time sent) {
  is_renewed_ = true;
  renewing_ = false;
  if (lease_.confirm(sent)) return;
  if (!checking_.exchange(true)) post([this, sent] { check_sessions(sent); });
}

void ClusterNode::note_failed_renewal(const NatsError& error) {
  renewing_ = false;
  if (is_renewed_.exchange(false)) log_warning("the lease is not renewed: {}", error.what());
}

std::shared_ptr<SessionReplica> ClusterNode::replica_of(std::uint64_t session) {
  const auto hosted = find_hosted(session);
  if (hosted) return hosted->stream;
  // The session was lost during its recovery. Its end follows.
  SessionStream::Place place;
  place.session = session;
  const auto stream = make_stream(std::move(place));
  stream->end();
  return stream;
}

std::optional<ClusterNode::Hosted> ClusterNode::find_hosted(std::uint64_t session) const {
  const std::lock_guard lock(mutex_);
  const auto found = hosted_.find(session);
  if (found == hosted_.end()) return {};
  return found->second;
}

InstructionSet ClusterNode::common_instructions(InstructionSet greatest) const {
  for (const NodeInfo& node : nodes_.seen_within(Lease::kOthersTime)) {
    const Result<InstructionSet> has = parse_instruction_set(node.instruction_set);
    if (has) greatest = std::min(greatest, has.value());
  }
  return greatest;
}

std::optional<std::string> ClusterNode::url_of(const LocatedSession& session) const {
  // The request waits if the owner may have failed, and is answered after its next renewal.
  if (session.owner.empty() || !nodes_.is_seen_within(session.owner, entry_age())) return {};
  const auto node = nodes_.find(session.owner);
  if (!node) return {};
  return node->url;
}

std::vector<LocatedSession> ClusterNode::replays() const {
  std::vector<LocatedSession> replays;
  for (const NodeInfo& node : nodes_.seen_within(Lease::kOthersTime)) {
    if (node.name == name()) continue;
    for (const auto& [number, shown] : node.replays) {
      LocatedSession replay;
      replay.number = number;
      replay.name = shown;
      replay.owner = node.name;
      replay.epoch = 1;
      replays.push_back(std::move(replay));
    }
  }
  return replays;
}

std::optional<LocatedSession> ClusterNode::find(std::uint64_t session) const {
  if (auto located = locator_.find(session)) return located;
  for (LocatedSession& replay : replays()) {
    if (replay.number == session) return std::move(replay);
  }
  return {};
}

std::vector<std::string> ClusterNode::urls() const {
  std::vector<std::string> urls;
  for (const NodeInfo& node : nodes_.seen_within(Lease::kOthersTime)) urls.push_back(node.url);
  return urls;
}

std::string ClusterNode::best_node() const {
  constexpr double kLeastGain = 0.5;  // cores; a session of this node needs no redirection
  std::string best = name();
  double room = cores_ - load_ + kLeastGain;
  for (const NodeInfo& node : nodes_.seen_within(fresh())) {
    if (!node.accepts || node.room <= room) continue;
    best = node.name;
    room = node.room;
  }
  return best;
}

std::string ClusterNode::create_at(const std::string& node, const std::string& request) {
  constexpr milliseconds kTime(20'000);  // a large scene
  return connection_.request("vat.node." + node + ".create", request, kTime).data;
}

}  // namespace vat
