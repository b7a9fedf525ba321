#include <algorithm>
#include <set>

#include "core/limits.h"
#include "core/sampling/nozzle.h"
#include "core/validation/validate_parts.h"

namespace vat {
namespace {

constexpr Real kMinFlow = 1e-6;  // [m/s]

/// Checks the names of the elements, and their number.
template <class Element>
bool check_names(const std::vector<Element>& elements, std::size_t most, const std::string& path,
                 RangeCheck& check) {
  if (elements.size() > most) {
    check.add("too_many", path, "at most " + std::to_string(most));
    return false;
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    const std::string at = path + '/' + std::to_string(i) + "/name";
    check.text(elements[i].name, kMaxNameLength, false, at);
    if (!names.insert(elements[i].name).second) {
      check.add("duplicate", at, "must not be the name of an earlier one");
    }
  }
  return true;
}

/// The liquid body of an emitter; null, with an error, if there is none.
const BodyDescription* find_fed_body(const Scene& scene, const Emitter& emitter,
                                     const std::string& path, RangeCheck& check) {
  const auto body = std::ranges::find(scene.bodies, emitter.body, &BodyDescription::name);
  if (body == scene.bodies.end()) {
    check.add_unknown(path, "must be the name of one of the scene's bodies", emitter.body,
                      scene.bodies, &BodyDescription::name);
    return nullptr;
  }
  const auto material = std::ranges::find(scene.materials, body->material, &Material::name);
  if (body->kind != BodyKind::liquid || material == scene.materials.end() || !material->liquid ||
      !(body->spacing >= kMinLength)) {
    check.add("not_liquid", path, "must be a liquid body with a spacing");
    return nullptr;
  }
  return &*body;
}

void check_opening(const Emitter& emitter, const std::string& path, RangeCheck& check) {
  if (emitter.radius.has_value() == emitter.size.has_value()) {
    check.add("not_allowed", path + "/radius", "must be given, or a size, but not both");
  }
  if (emitter.radius) check.real(*emitter.radius, kMinLength, kMaxLength, path + "/radius");
  for (std::size_t edge = 0; emitter.size && edge < 2; ++edge) {
    check.real((*emitter.size)[edge], kMinLength, kMaxLength,
               path + "/size/" + std::to_string(edge));
  }
}

/// Checks that both ends of the tube stay in the vat during its motion.
void check_tube(const Scene& scene, const Emitter& emitter, const std::string& path,
                RangeCheck& check) {
  if (!scene.vat) return;
  const auto& motion = scene.vat->motion;
  const Vec3 slide = motion ? Vec3(motion->stroke * motion->axis.normalized()) : Vec3::Zero();
  const Nozzle nozzle = make_nozzle(scene, emitter);
  const Vec3 tube = static_cast<Real>(nozzle.inside) * nozzle.interval * nozzle.velocity;
  for (const Vec3& place : nozzle.layer) {
    const auto stays_in = [&](const Vec3& end) {
      return is_inside_vat(scene, end) && is_inside_vat(scene, end - slide);
    };
    if (stays_in(place) && stays_in(place - tube)) continue;
    check.add("outside_vat", path + "/position",
              "must keep the nozzle, which is one support radius long, inside the vat");
    return;
  }
}

void check_layers(const Scene& scene, const Emitter& emitter, const BodyDescription& body,
                  const std::string& path, RangeCheck& check) {
  const char* const opening = emitter.size ? "/size" : "/radius";
  if (lattice_points(emitter, body.spacing, scene.dimensions) > Real{kMaxParticles}) {
    check.add("out_of_range", path + opening, "must have room for at most 1000000 particles");
    return;
  }
  const std::size_t layer = layer_of(emitter, body.spacing, scene.dimensions).size();
  check.real(static_cast<Real>(emitter.most_particles), static_cast<Real>(layer),
             static_cast<Real>(kMaxParticles), path + "/most_particles");
  check_tube(scene, emitter, path, check);
}

void check_emitter(const Scene& scene, const Emitter& emitter, const std::string& path,
                   Errors& errors) {
  RangeCheck check(errors);
  const std::size_t errors_before = errors.size();
  const BodyDescription* body = find_fed_body(scene, emitter, path + "/body", check);
  check.vector(emitter.position, -kMaxLength, kMaxLength, path + "/position");
  if (check.vector(emitter.direction, -kMaxLength, kMaxLength, path + "/direction") &&
      !(emitter.direction.norm() > 0)) {
    check.add("out_of_range", path + "/direction", "must not be zero");
  }
  check_opening(emitter, path, check);
  check.real(emitter.from, 0, Emitter::kNoEnd, path + "/from");
  check.real(emitter.until, emitter.from, Emitter::kNoEnd, path + "/until");
  if (body == nullptr) return;
  // In one step at most one layer enters a nozzle.
  const Real fastest = std::min(kMaxSpeed, body->spacing / scene.numerics.step);
  check.real(emitter.speed, kMinFlow, fastest, path + "/speed");
  if (errors.size() == errors_before) check_layers(scene, emitter, *body, path, check);
}

}  // namespace

void check_flow(const Scene& scene, Errors& errors) {
  RangeCheck check(errors);
  if (!check_names(scene.emitters, kMaxEmitters, "/emitters", check)) return;
  for (std::size_t e = 0; e < scene.emitters.size(); ++e) {
    check_emitter(scene, scene.emitters[e], "/emitters/" + std::to_string(e), errors);
  }
  if (!check_names(scene.drains, kMaxDrains, "/drains", check)) return;
  for (std::size_t d = 0; d < scene.drains.size(); ++d) {
    const Drain& drain = scene.drains[d];
    const std::string path = "/drains/" + std::to_string(d);
    const bool is_finite = check.vector(drain.min, -kMaxLength, kMaxLength, path + "/min") &&
                           check.vector(drain.max, -kMaxLength, kMaxLength, path + "/max");
    if (is_finite && !(drain.min.array() < drain.max.array()).all()) {
      check.add("out_of_range", path + "/max", "must be above min along every axis");
    }
  }
}

}  // namespace vat
