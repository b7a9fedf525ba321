#include "server/cluster/node_table.h"

#include <algorithm>
#include <utility>

#include "core/support/instruction_set.h"
#include "protocol/json/json_reader.h"

namespace vat {
namespace {

std::uint64_t hash_of_node(std::uint64_t session, const std::string& name) {
  std::uint64_t hash = 0xcbf29ce484222325;  // FNV-1a
  const auto add = [&hash](std::uint64_t byte) { hash = (hash ^ byte) * 0x100000001b3; };
  for (int shift = 0; shift < 64; shift += 8) add(session >> shift & 0xff);
  for (const char c : name) add(static_cast<unsigned char>(c));
  hash ^= hash >> 33;  // FNV-1a alone mixes the last bytes too little
  hash *= 0xff51afd7ed558ccd;
  return hash ^ hash >> 33;
}

/// Returns the place of a node in the order of the nodes that should take the session.
std::pair<std::uint64_t, std::string_view> place_of(std::uint64_t session,
                                                    const std::string& name) {
  return {~hash_of_node(session, name), name};
}

}  // namespace

std::string write_node(const NodeInfo& node) {
  Json json{{"node", node.name},       {"instance", node.instance},
            {"url", node.url},         {"instruction_set", node.instruction_set},
            {"version", node.version}, {"room", node.room},
            {"accepts", node.accepts}};
  // Most nodes have none, and all nodes receive the entry often.
  for (const auto& [number, name] : node.replays) {
    json["replays"].push_back({{"number", number}, {"name", name}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool has_instructions(const NodeInfo& node, const std::string& instruction_set) {
  const Result<InstructionSet> has = parse_instruction_set(node.instruction_set);
  const Result<InstructionSet> needed = parse_instruction_set(instruction_set);
  return has && needed && has.value() >= needed.value();
}

std::optional<NodeInfo> read_node(const std::string& name, const std::string& text) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object()) return {};
  try {
    if (json.at("node") != name) return {};
    NodeInfo node{
        json.at("node"),    json.at("instance"), json.at("url"),    json.at("instruction_set"),
        json.at("version"), json.at("room"),     json.at("accepts")};
    for (const Json& replay : json.value("replays", Json::array())) {
      node.replays[replay.at("number")] = replay.at("name");
    }
    return node;
  } catch (const Json::exception&) {
    return {};
  }
}

void NodeTable::note(NodeInfo node, std::uint64_t revision) {
  const std::lock_guard lock(mutex_);
  std::string name = node.name;
  nodes_[std::move(name)] = {std::move(node), clock_.now(), revision};
}

std::uint64_t NodeTable::revision_of(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(name);
  return found == nodes_.end() ? 0 : found->second.revision;
}

void NodeTable::note_replays(const std::string& name,
                             std::map<std::uint64_t, std::string> replays) {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(name);
  if (found != nodes_.end()) found->second.node.replays = std::move(replays);
}

void NodeTable::forget(const std::string& name) {
  const std::lock_guard lock(mutex_);
  nodes_.erase(name);
}

std::optional<NodeInfo> NodeTable::find(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(name);
  if (found == nodes_.end()) return {};
  return found->second.node;
}

std::vector<NodeInfo> NodeTable::seen_within(SteadyClock::duration time) const {
  const std::lock_guard lock(mutex_);
  std::vector<NodeInfo> nodes;
  for (const auto& [name, seen] : nodes_) {
    if (clock_.now() - seen.time < time) nodes.push_back(seen.node);
  }
  return nodes;
}

bool NodeTable::is_seen_within(const std::string& name, SteadyClock::duration time) const {
  return silence_of(name) < time && find(name).has_value();
}

SteadyClock::duration NodeTable::silence_of(const std::string& name) const {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(name);
  return clock_.now() - (found == nodes_.end() ? begin_ : found->second.time);
}

std::size_t NodeTable::count_before(const std::string& name, std::uint64_t session,
                                    SteadyClock::duration time,
                                    const std::function<bool(const NodeInfo&)>& can_take) const {
  const auto own = place_of(session, name);
  const std::lock_guard lock(mutex_);
  const auto now = clock_.now();
  return static_cast<std::size_t>(std::ranges::count_if(nodes_, [&](const auto& node) {
    const Seen& seen = node.second;
    return now - seen.time < time && seen.node.accepts && can_take(seen.node) &&
           place_of(session, node.first) < own;
  }));
}

std::vector<std::string> rank_nodes(std::uint64_t session, std::vector<std::string> names) {
  std::ranges::sort(names, {},
                    [session](const std::string& name) { return place_of(session, name); });
  return names;
}

}  // namespace vat
