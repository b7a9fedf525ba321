// scene.get

#include "core/limits.h"
#include "server/session/method_table.h"
#include "server/session/scene_loading.h"

namespace vat {
namespace {

/// What a message of scene.load has beside the scene, and more.
constexpr std::size_t kCallBytes = 256;
constexpr std::size_t kCallValues = 8;

/// As parse_json() counts them; up to `most` and a few more.
std::size_t count_values(const Json& json, std::size_t most) {
  std::size_t count = 1;
  for (auto each = json.begin(); json.is_structured() && each != json.end(); ++each) {
    if (count > most) return count;
    count += count_values(*each, most - count);
  }
  return count;
}

/// The scene, where a message that loads it again may be as long.
ActionResult give(Json scene, const ServerLimits& limits) {
  // Before it is written: that may be more than once.
  if (count_values(scene, limits.max_message_values) + kCallValues > limits.max_message_values) {
    return limit_reached("message_values", limits.max_message_values);
  }
  if (scene.dump().size() + kCallBytes > limits.max_scene_message_bytes) {
    return limit_reached("scene_message_bytes", limits.max_scene_message_bytes);
  }
  return Json{{"scene", std::move(scene)}};
}

ActionResult get_named(const std::string& name, const SessionEnvironment& environment) {
  if (const Scene* scene = environment.catalogue.find(name)) {
    return give(write_scene(*scene), environment.limits);
  }
  auto saved = find_saved_scene(name, environment);
  if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
  return give(std::get<Json>(std::move(saved)), environment.limits);
}

SessionAction read_get(ObjectReader& params, Errors& errors) {
  if (params.has("scene")) {
    if (params.has("current")) {
      add_error(errors, "not_together", params.path_of("current"), "must not be given with a name");
      params.boolean("current");
    }
    const std::string name = params.text("scene", kMaxNameLength);
    return [name](SessionCore& core, Participant&) { return get_named(name, core.environment()); };
  }
  const bool is_current = params.boolean("current", false);
  return [is_current](SessionCore& core, Participant&) {
    const Scene& scene =
        is_current ? core.run().simulation().scene() : core.run().as_loaded().scene();
    return give(write_scene(scene), core.environment().limits);
  };
}

constexpr Method kSceneMethods[] = {
    {"scene.get", read_get},
};

}  // namespace

std::span<const Method> scene_methods() {
  return kSceneMethods;
}

}  // namespace vat
