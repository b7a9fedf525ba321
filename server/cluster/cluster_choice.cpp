// Choice of the sessions that a node takes.

#include <boost/asio/post.hpp>
#include <vector>

#include "server/cluster/cluster_node.h"

namespace vat {
namespace {

// A changed session is looked at at once. These looks also find the sessions whose take-over was
// not possible at that time.
constexpr std::chrono::milliseconds kLook(1000);
constexpr std::chrono::milliseconds kOrphanTurn(1000);
constexpr std::chrono::milliseconds kFailedPause(5000);

}  // namespace

void ClusterNode::separate_leaders() {
  for (const NodeInfo& node : nodes_.seen_within(Lease::kOthersTime)) {
    if (node.name < name()) return;  // the first node does it
  }
  const auto separate = [](Stream& stream, Stream& spare) {
    const auto leader = stream.leader();
    if (leader && spare.leader() == leader) spare.change_leader();
  };
  separate(streams_.logs[0], streams_.logs[1]);
  separate(node_bucket_.stream(), spare_bucket_.stream());
}

void ClusterNode::look_at_change(std::uint64_t session) {
  if (leaving_) return;
  const auto entry = locator_.find(session);
  if (entry && lease_.is_valid()) look_at(*entry);
  host_->cluster_changed();
}

void ClusterNode::look_at_sessions(Time now) {
  const auto look_at_all_of = [this](const std::string& owner) {
    for (const LocatedSession& entry : locator_.sessions_of(owner)) look_at(entry);
  };
  std::map<std::string, Time> silent_looks;
  for (const std::string& owner : locator_.owners()) {
    if (owner.empty() || owner == name()) continue;
    if (nodes_.silence_of(owner) < Lease::kOthersTime) continue;
    const auto known = silent_looks_.find(owner);
    const bool is_due = known == silent_looks_.end() || now - known->second >= kLook;
    silent_looks[owner] = is_due ? now : known->second;
    if (is_due) look_at_all_of(owner);
  }
  silent_looks_ = std::move(silent_looks);
  if (now - last_look_ < kLook) return;
  last_look_ = now;
  look_at_all_of("");
  look_at_all_of(name());
  std::vector<std::uint64_t> numbers;
  {
    const std::lock_guard lock(mutex_);
    for (const auto& [number, hosted] : hosted_) numbers.push_back(number);
  }
  for (const std::uint64_t number : numbers) {
    const auto entry = locator_.find(number);
    if (entry && entry->owner != name()) look_at(*entry);
  }
}

void ClusterNode::look_at(const LocatedSession& entry) {
  {
    const std::lock_guard lock(mutex_);
    if (reserved_.contains(entry.number)) return;
  }
  if (const auto hosted = find_hosted(entry.number)) {
    // The caller's copy may be older than the take-over by this node.
    const bool is_newer = entry.revision > hosted->entry.revision;
    if (is_newer && (entry.owner != name() || entry.epoch > hosted->entry.epoch)) {
      post([this, number = entry.number] { lose(number); });
    }
    return;
  }
  if (!is_wanted(entry)) return;
  {
    const std::lock_guard lock(mutex_);
    if (reserved_.contains(entry.number)) return;
    reserved_.insert(entry.number);
  }
  post([this, number = entry.number] { take(number); });
}

bool ClusterNode::is_wanted(const LocatedSession& entry) {
  const auto now = clock_.now();
  const bool has_owner = !entry.owner.empty();
  const std::lock_guard lock(mutex_);
  const auto failed = failed_.find(entry.number);
  if (failed != failed_.end() && now - failed->second < kFailedPause) return false;
  if (entry.owner == name()) return true;
  if (draining_) return false;
  if (!has_owner && entry.successor == name()) return true;
  // After an outage, the other nodes first get the time to renew their leases.
  const bool may_judge = now - lease_.held_since() >= Lease::kOthersTime;
  const bool is_orphan = has_owner
                             ? may_judge && nodes_.silence_of(entry.owner) >= Lease::kOthersTime
                             : !nodes_.is_seen_within(entry.successor, fresh());
  if (!is_orphan) {
    orphans_.erase(entry.number);
    return false;
  }
  const auto since = orphans_.emplace(entry.number, now).first->second;
  return is_my_turn(entry, now - since);
}

bool ClusterNode::is_my_turn(const LocatedSession& entry, SteadyClock::duration orphaned) const {
  const Result<InstructionSet> needed = parse_instruction_set(entry.instruction_set);
  if (!needed || !check_available(needed.value())) return false;
  if (!nodes_.is_seen_within(name(), fresh())) return false;
  const std::size_t before = nodes_.count_before(
      name(), entry.number, fresh(),
      [&](const NodeInfo& node) { return has_instructions(node, entry.instruction_set); });
  return orphaned >= static_cast<int>(before) * kOrphanTurn;
}

}  // namespace vat
