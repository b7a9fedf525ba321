#include "core/scene/idle_settings.h"

#include <algorithm>
#include <string>

namespace vat {
namespace {

void warn(std::string path, std::string message, std::vector<Warning>& warnings) {
  warnings.push_back({"no_effect", std::move(path), "has no effect: " + std::move(message)});
}

bool has_viscous_liquid(const Scene& scene) {
  return scene.forces.viscosity &&
         std::ranges::any_of(scene.bodies, [&](const BodyDescription& body) {
           if (body.kind != BodyKind::liquid) return false;
           const auto material = std::ranges::find(scene.materials, body.material, &Material::name);
           return material->liquid->viscosity > 0;
         });
}

void warn_of_vat_walls(const Scene& scene, std::vector<Warning>& warnings) {
  const bool has_drag = has_viscous_liquid(scene);
  for (std::size_t i = 0; i < kWallNames.size(); ++i) {
    const Wall& wall = scene.vat->walls[i];
    const std::string path = std::string("/vat/walls/") + kWallNames[i];
    if (wall.no_slip && !has_drag) {
      warn(path + "/no_slip", "no liquid of the scene is viscous", warnings);
    }
    if (!wall.no_slip && !wall.velocity.isZero(0)) {
      warn(path + "/velocity", "a wall without no_slip drags nothing along", warnings);
    }
  }
}

void warn_of_tolerance(const Numerics& numerics, std::vector<Warning>& warnings) {
  if (numerics.accuracy || numerics.tolerance == Numerics{}.tolerance) return;
  if (numerics.control == StepControl::fixed) {
    warn("/numerics/tolerance", "steps are fixed", warnings);
  } else if (numerics.control == StepControl::local) {
    warnings.push_back({"no_effect", "/numerics/tolerance",
                        "has an effect on contacts only: local control keeps the rest stable"});
  } else if (numerics.integrator == IntegratorId::explicit_euler ||
             numerics.integrator == IntegratorId::symplectic_euler) {
    warnings.push_back({"no_effect", "/numerics/tolerance",
                        "has an effect on contacts only: with one evaluation a step, " +
                            std::string(to_string(numerics.integrator)) +
                            " cannot tell its error"});
  }
}

}  // namespace

void warn_of_idle_settings(const Scene& scene, std::vector<Warning>& warnings) {
  if (scene.vat) warn_of_vat_walls(scene, warnings);
  if (scene.central_field && !scene.forces.gravity) {
    warn("/central_field", "gravity is off, and the central field with it", warnings);
  }
  warn_of_tolerance(scene.numerics, warnings);
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    const std::string path = "/bodies/" + std::to_string(b);
    if (body.seed != 0 && body.jitter == 0) {
      warn(path + "/seed", "the body has no jitter", warnings);
    }
  }
}

}  // namespace vat
