#include "server/history/session_moment.h"

#include <limits>
#include <string_view>
#include <utility>

#include "core/limits.h"

namespace vat {
namespace {

constexpr std::string_view kHexDigits = "0123456789abcdef";
constexpr std::uint64_t kAnyCount = std::uint64_t{1} << 53;  // JSON numbers up to this are exact

std::string to_hex(const TokenHash& hash) {
  std::string text;
  for (const std::uint8_t byte : hash) {
    text += kHexDigits[byte >> 4];
    text += kHexDigits[byte & 15];
  }
  return text;
}

std::optional<TokenHash> from_hex(std::string_view text) {
  TokenHash hash{};
  if (text.size() != 2 * hash.size()) return {};
  for (std::size_t i = 0; i < text.size(); ++i) {
    const std::size_t digit = kHexDigits.find(text[i]);
    if (digit == std::string_view::npos) return {};
    hash[i / 2] = static_cast<std::uint8_t>(std::size_t{hash[i / 2]} << 4 | digit);
  }
  return hash;
}

[[noreturn]] void fail(const Errors& errors) {
  const Error& first = errors.front();
  throw StorageError(StorageError::Kind::corrupt,
                     "a stored session: " + first.path + ": " + first.message);
}

Json parse(const std::string& text) {
  Result<Json> json = parse_json(text, {text.size(), 16, text.size()});
  if (!json) fail(json.errors());
  return std::move(json).value();
}

constexpr Role kAllRoles[] = {Role::viewer, Role::controller, Role::owner, Role::admin};

Role read_role(ObjectReader& reader, std::string_view key) {
  return kAllRoles[reader.choice(key, {"viewer", "controller", "owner", "admin"})];
}

Json write_subscription(const Subscription& subscription) {
  Json json{{"every", subscription.every},
            {"detail", subscription.selection.detail},
            {"attributes", subscription.attribute_errors}};
  if (subscription.max_error) json["max_error"] = *subscription.max_error;
  if (const auto& region = subscription.selection.region) {
    json["min"] = to_json(region->min);
    json["max"] = to_json(region->max);
  }
  return json;
}

Subscription read_subscription(const Json& value, const std::string& path, Errors& errors) {
  ObjectReader reader(value, path, errors);
  Subscription read;
  read.every = reader.count("every", 1, kMaxFrameInterval);
  read.selection.detail = static_cast<std::uint8_t>(reader.count("detail", 0, kFullDetail));
  if (reader.has("max_error")) read.max_error = reader.real("max_error", 0, kMaxLength);
  if (reader.has("min")) {
    read.selection.region = FrameRegion{reader.vector("min", -kMaxLength, kMaxLength),
                                        reader.vector("max", -kMaxLength, kMaxLength)};
  }
  if (const Json* attributes = reader.array("attributes", kFrameAttributes, true)) {
    for (std::size_t a = 0; a < attributes->size(); ++a) {  // older versions had fewer
      const std::string at = pointer_to(reader.path_of("attributes"), a);
      read.attribute_errors[a] = to_real((*attributes)[a], at, 0, kAnyMax, errors).value_or(0);
    }
  }
  return read;
}

void read_participant(const Json& value, const std::string& path, Participants& participants,
                      Errors& errors) {
  ObjectReader reader(value, path, errors);
  Participant& participant = participants.find_or_add(reader.count("number", 1, kAnyCount));
  participant.name = reader.text("name", kMaxNameLength);
  participant.role = read_role(reader, "role");
  participant.resume = from_hex(reader.text("resume", 2 * TokenHash().size()));
  if (const Json* subscription = reader.member("subscription")) {
    participant.subscription =
        read_subscription(*subscription, reader.path_of("subscription"), errors);
  }
  const Json* grabs = reader.array("grabs", kMaxGrabs, true);
  if (grabs == nullptr) return;
  for (std::size_t i = 0; i < grabs->size(); ++i) {
    ObjectReader grab((*grabs)[i], pointer_to(reader.path_of("grabs"), i), errors);
    const std::uint64_t id = grab.count("grab", 0, kAnyCount);
    participant.grabs[id] =
        static_cast<BodyId>(grab.count("body", 0, std::numeric_limits<BodyId>::max()));
  }
}

}  // namespace

SessionProgress SessionMoment::progress() const {
  return {position, tick,    sequence, snapshot.state_hash(),
          epoch,    playing, speed,    participants.dump()};
}

std::string SessionMoment::fields() const {
  Json fields{{"position", position}, {"tick", tick},           {"sequence", sequence},
              {"loaded", loaded},     {"last_grab", last_grab}, {"epoch", epoch},
              {"playing", playing},   {"speed", speed},         {"participants", participants}};
  if (on_cpu) fields["on_cpu"] = true;
  return fields.dump();
}

SessionMoment read_moment(const std::string& fields, Snapshot snapshot) {
  const Json json = parse(fields);
  Errors errors;
  ObjectReader reader(json, "", errors);
  SessionMoment moment{.participants = {}, .snapshot = std::move(snapshot)};
  moment.position = reader.count("position", 0, kAnyCount);
  moment.tick = reader.count("tick", 0, kAnyCount);
  moment.sequence = reader.count("sequence", 1, kAnyCount);
  moment.loaded = reader.count("loaded", 1, kAnyCount);
  moment.last_grab = reader.count("last_grab", 0, kAnyCount);
  moment.epoch = static_cast<std::uint32_t>(reader.count("epoch", 1, ~std::uint32_t{0}));
  moment.playing = reader.boolean("playing");
  moment.speed = reader.real("speed", 0, kAnyMax);
  moment.on_cpu = reader.boolean("on_cpu", false);
  if (const Json* participants = reader.member("participants", true)) {
    moment.participants = *participants;
  }
  if (!errors.empty()) fail(errors);
  return moment;
}

Json write_settings(const SessionSettings& settings) {
  Json written{{"default_role", to_string(settings.default_role)}, {"locked", settings.is_locked}};
  const GovernorPermission& governor = settings.governor;
  if (!governor.points.empty()) {
    written["governor"] = {{"scene", governor.scene},
                           {"points", write_governor_points(governor.points)}};
  }
  return written;
}

SessionSettings read_settings(std::string name, const std::string& settings) {
  const Json json = parse(settings);
  Errors errors;
  ObjectReader reader(json, "", errors);
  SessionSettings read;
  read.name = std::move(name);
  read.default_role = read_role(reader, "default_role");
  read.is_locked = reader.boolean("locked");
  if (const Json* governor = reader.member("governor")) {
    ObjectReader permission(*governor, reader.path_of("governor"), errors);
    read.governor.scene = permission.count("scene", 1, kAnyCount);
    read.governor.points = read_governor_points(permission, "points", errors);
  }
  if (!errors.empty()) fail(errors);
  return read;
}

Json write_participants(const Participants& participants) {
  Json list = Json::array();
  for (const auto& [number, participant] : participants.all()) {
    Json grabs = Json::array();
    for (const auto& [grab, body] : participant.grabs) {
      grabs.push_back({{"grab", grab}, {"body", body}});
    }
    list.push_back({{"number", number},
                    {"name", participant.name},
                    {"role", to_string(participant.role)},
                    {"resume", participant.resume ? to_hex(*participant.resume) : ""},
                    {"grabs", std::move(grabs)}});
    if (participant.subscription) {
      list.back()["subscription"] = write_subscription(*participant.subscription);
    }
  }
  return {{"last", participants.last_number()}, {"list", std::move(list)}};
}

void read_participants(const Json& json, Participants& participants) {
  Errors errors;
  ObjectReader reader(json, "", errors);
  const std::uint64_t last = reader.count("last", 0, kAnyCount);
  const Json* list = reader.member("list", true);
  if (list != nullptr && list->is_array()) {
    for (std::size_t i = 0; i < list->size(); ++i) {
      read_participant((*list)[i], pointer_to("/list", i), participants, errors);
    }
  }
  if (!errors.empty()) fail(errors);
  participants.skip_to(last);
}

}  // namespace vat
