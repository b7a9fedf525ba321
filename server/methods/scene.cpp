// scene.get

#include "core/limits.h"
#include "core/support/check.h"
#include "server/methods/handlers.h"
#include "server/session/core/scene_loading.h"
#include "server/session/core/session_view.h"

namespace vat {
namespace {

/// Upper bounds of the rest of a scene.load message.
constexpr std::size_t kCallBytes = 256;
constexpr std::size_t kCallValues = 8;

/// Counts values as parse_json() does. Stops somewhat above `most`.
std::size_t count_values(const Json& json, std::size_t most) {
  std::size_t count = 1;
  for (auto each = json.begin(); json.is_structured() && each != json.end(); ++each) {
    if (count > most) return count;
    count += count_values(*each, most - count);
  }
  return count;
}

/// Returns the scene, or the limit that a message which loads it would exceed.
RpcResult give(Json scene, const ServerLimits& limits) {
  // Counted before it is written, which takes long.
  if (count_values(scene, limits.max_message_values) + kCallValues > limits.max_message_values) {
    return limit_reached("message_values", limits.max_message_values);
  }
  if (scene.dump().size() + kCallBytes > limits.max_scene_message_bytes) {
    return limit_reached("scene_message_bytes", limits.max_scene_message_bytes);
  }
  return Json{{"scene", std::move(scene)}};
}

RpcResult get_named(const std::string& name, const SessionEnvironment& environment) {
  const Scene* const scene = environment.catalogue.find(name);
  VAT_CHECK(scene != nullptr);
  return give(write_scene(*scene), environment.limits);
}

RpcResult get_saved(const std::string& name, const SessionEnvironment& environment) {
  auto saved = find_saved_scene(name, environment);
  if (auto* error = std::get_if<RpcError>(&saved)) return std::move(*error);
  return give(std::get<Json>(std::move(saved)), environment.limits);
}

}  // namespace

SessionAction read_scene_get(ObjectReader& params, Errors& errors) {
  if (params.has("scene")) {
    if (params.has("current")) {
      add_error(errors, "not_together", params.path_of("current"), "must not be given with a name");
      params.boolean("current");
    }
    const std::string name = params.text("scene", kMaxNameLength);
    return [name](SessionCore& core, Participant&) -> ActionResult {
      const SessionEnvironment& environment = core.environment();
      if (environment.catalogue.find(name) == nullptr) {
        return StorageWork{[name, &environment] { return get_saved(name, environment); }};
      }
      return Read{
          false, [name, &environment](SessionView&) { return get_named(name, environment); }, {}};
    };
  }
  const bool is_current = params.boolean("current", false);
  return [is_current](SessionCore& core, Participant&) -> ActionResult {
    const ServerLimits& limits = core.environment().limits;
    return Read{is_current,
                [is_current, &limits](SessionView& view) {
                  const Snapshot& wanted = is_current ? view.snapshot() : view.as_loaded();
                  return give(write_scene(wanted.scene()), limits);
                },
                {}};
  };
}

}  // namespace vat
