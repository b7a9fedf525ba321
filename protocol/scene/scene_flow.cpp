#include "core/limits.h"
#include "protocol/scene/scene_parts.h"

namespace vat::scene_parts {

Emitter to_emitter(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Emitter emitter;
  emitter.name = reader.text("name", kMaxNameLength);
  emitter.body = reader.text("body", kMaxNameLength);
  emitter.position = reader.vector("position", -kMaxLength, kMaxLength);
  emitter.direction = reader.vector("direction", -kMaxLength, kMaxLength, emitter.direction);
  if (reader.has("radius")) emitter.radius = reader.real("radius", kMinLength, kMaxLength);
  if (const Json* size = reader.member("size")) {
    const std::string at = reader.path_of("size");
    if (to_array(*size, at, 2, 2, errors) != nullptr) {
      const auto edge = [&](std::size_t i) {
        return to_real((*size)[i], pointer_to(at, i), kMinLength, kMaxLength, errors)
            .value_or(kMinLength);
      };
      emitter.size = {edge(0), edge(1)};
    }
  }
  emitter.speed = reader.real("speed", 0, kMaxSpeed);
  emitter.from = reader.real("from", 0, Emitter::kNoEnd, emitter.from);
  emitter.until = reader.real("until", 0, Emitter::kNoEnd, emitter.until);
  emitter.most_particles = reader.count("most_particles", 1, kMaxParticles);
  emitter.open = reader.boolean("open", emitter.open);
  reader.refuse_unknown();
  return emitter;
}

Drain to_drain(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Drain drain;
  drain.name = reader.text("name", kMaxNameLength);
  drain.min = reader.vector("min", -kMaxLength, kMaxLength);
  drain.max = reader.vector("max", -kMaxLength, kMaxLength);
  reader.refuse_unknown();
  return drain;
}

}  // namespace vat::scene_parts
