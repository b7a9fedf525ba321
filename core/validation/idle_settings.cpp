#include "core/validation/validate_parts.h"

#include <algorithm>
#include <string>

#include "core/laws/vat_motion.h"
#include "core/numerics/error_model.h"
#include "core/sampling/volumes.h"
#include "core/scene/interface_table.h"
#include "core/scene/lookup.h"

namespace vat {
namespace {

void warn(std::string path, std::string message, std::vector<Warning>& warnings) {
  warnings.push_back({"no_effect", std::move(path), "has no effect: " + std::move(message)});
}

bool has_viscous_liquid(const Scene& scene) {
  const bool has_artificial = couples_liquids(scene.pressure_solver);
  return scene.forces.viscosity &&
         std::ranges::any_of(scene.bodies, [&](const BodyDescription& body) {
           if (body.kind != BodyKind::liquid) return false;
           const LiquidConstants& liquid = *material_of(scene, body).liquid;
           return liquid.viscosity > 0 || (has_artificial && liquid.artificial_viscosity > 0);
         });
}

bool has_wall_friction(const Scene& scene) {
  const InterfaceTable table(scene.materials, scene.interfaces);
  return scene.forces.walls && std::ranges::any_of(scene.bodies, [&](const BodyDescription& body) {
           const auto found = table.with_walls(material_index(scene.materials, body.material));
           const InterfaceConstants& law =
               found ? scene.interfaces[*found].constants : scene.default_interface;
           return law.friction > 0;
         });
}

/// Friction is proportional to the force of the spring, and its sticking to the stiffness.
void warn_of_friction(const InterfaceConstants& constants, const std::string& path,
                      std::vector<Warning>& warnings) {
  const bool is_penalty = constants.law == InterfaceLaw::penalty;
  if (is_penalty && constants.friction > 0 && constants.stiffness == 0) {
    warn(path + "/friction", "the stiffness is 0", warnings);
  }
}

/// In coupled solvers, liquids interact with solids and walls by SPH for all laws.
void warn_of_law(const Scene& scene, const InterfaceDescription& interface, const std::string& path,
                 std::vector<Warning>& warnings) {
  if (scene.pressure_solver == PressureSolver::gas) return;
  const InterfaceLaw law = interface.constants.law;
  if (law != InterfaceLaw::lennard_jones && law != InterfaceLaw::projection) return;
  const bool is_liquid = std::ranges::any_of(interface.materials, [&](const std::string& name) {
    const auto is_of = [&](const BodyDescription& body) { return body.material == name; };
    const auto is_solid = [&](const BodyDescription& body) {
      return is_of(body) && body.kind != BodyKind::liquid;
    };
    return std::ranges::any_of(scene.bodies, is_of) && std::ranges::none_of(scene.bodies, is_solid);
  });
  if (!is_liquid) return;
  warn(path + "/law",
       std::string("with \"") + to_string(scene.pressure_solver) +
           "\" liquids interact with other materials by \"sph\"",
       warnings);
}

void warn_of_vat_walls(const Scene& scene, std::vector<Warning>& warnings) {
  const bool has_drag = has_viscous_liquid(scene);
  const bool has_friction = has_wall_friction(scene);
  for (std::size_t i = 0; i < kWallNames.size(); ++i) {
    const Wall& wall = scene.vat->walls[i];
    const std::string path = std::string("/vat/walls/") + kWallNames[i];
    if (wall.no_slip && !has_drag) {
      warn(path + "/no_slip", "no liquid of the scene is viscous", warnings);
    }
    if (!wall.no_slip && !has_friction && !wall.velocity.isZero(0)) {
      warn(path + "/velocity", "a wall without no_slip or friction exerts no drag", warnings);
    }
  }
}

bool has_surface_tension(const Scene& scene) {
  return std::ranges::any_of(scene.bodies, [&](const BodyDescription& body) {
    if (body.kind != BodyKind::liquid && !body.melting) return false;
    const std::string& name = body.melting ? body.melting->into : body.material;
    return std::ranges::find(scene.materials, name, &Material::name)->liquid->surface_tension > 0;
  });
}

/// Returns whether the interface joins a liquid with surface tension to a wall or a solid.
bool has_surface(const Scene& scene, const InterfaceDescription& interface) {
  const auto is_liquid_body = [&](const std::string& name) {
    return std::ranges::any_of(scene.bodies, [&](const BodyDescription& body) {
      return body.kind == BodyKind::liquid && body.material == name;
    });
  };
  if (std::ranges::all_of(interface.materials, is_liquid_body)) return false;
  return std::ranges::any_of(interface.materials, [&](const std::string& name) {
    const auto material = std::ranges::find(scene.materials, name, &Material::name);
    return material != scene.materials.end() && material->liquid &&
           material->liquid->surface_tension > 0;
  });
}

void warn_of_surfaces(const Scene& scene, std::vector<Warning>& warnings) {
  const bool is_idle = !has_surface_tension(scene);
  const char* const reason = "no liquid of the scene has surface tension";
  if (is_idle && scene.surface_model != Scene{}.surface_model) {
    warn("/surface_tension_model", reason, warnings);
  }
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const InterfaceDescription& interface = scene.interfaces[i];
    if (interface.contact_angle == kNeutralAngle) continue;
    const std::string path = "/interfaces/" + std::to_string(i) + "/contact_angle";
    if (is_idle) {
      warn(path, reason, warnings);
    } else if (!has_surface(scene, interface)) {
      warn(path, "it joins no liquid with surface tension to a solid", warnings);
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
  } else if (!estimates_errors(numerics)) {
    warnings.push_back({"no_effect", "/numerics/tolerance",
                        "has an effect on contacts only: with one evaluation a step, " +
                            std::string(to_string(numerics.integrator)) +
                            " cannot tell its error"});
  }
}

/// Returns whether the steps are local, or chosen from an accuracy.
bool may_be_local(const Numerics& numerics) {
  return numerics.accuracy || numerics.control == StepControl::local;
}

/// Warns of settings that the pressure solver does not use.
void warn_of_solver(const Scene& scene, std::vector<Warning>& warnings) {
  const bool is_incompressible = scene.pressure_solver == PressureSolver::incompressible;
  const IncompressibleSolve& solve = scene.incompressible;
  const IncompressibleSolve usual;
  const bool is_set = solve.density_tolerance != usual.density_tolerance ||
                      solve.divergence_tolerance != usual.divergence_tolerance ||
                      solve.most_iterations != usual.most_iterations;
  if (is_set && !is_incompressible) {
    warn("/incompressible", "the pressure solver is not \"incompressible\"", warnings);
  }
  const bool is_gas = scene.pressure_solver == PressureSolver::gas;
  if (scene.printed_pressure_force && !is_gas) {
    warn("/printed_pressure_force", "the pressure solver is not \"gas\"", warnings);
  }
  if (scene.kernel != Scene{}.kernel && is_gas) {
    warn("/kernel", "the pressure solver \"gas\" uses other kernels", warnings);
  }
  if (scene.pair_precision != Scene{}.pair_precision && is_gas) {
    warn("/pair_precision", "the pressure solver \"gas\" always uses double precision", warnings);
  }
  for (std::size_t m = 0; is_incompressible && m < scene.materials.size(); ++m) {
    const std::optional<LiquidConstants>& liquid = scene.materials[m].liquid;
    if (!liquid || liquid->stiffness == 0) continue;
    warn("/materials/" + std::to_string(m) + "/liquid/stiffness", "the liquid is incompressible",
         warnings);
  }
}

}  // namespace

void warn_of_idle_settings(const Scene& scene, std::vector<Warning>& warnings) {
  if (scene.vat) warn_of_vat_walls(scene, warnings);
  if (scene.central_field && !scene.forces.gravity) {
    warn("/central_field", "gravity is off, and the central field with it", warnings);
  }
  const auto is_liquid = [](const BodyDescription& body) { return body.kind == BodyKind::liquid; };
  if (scene.settling && std::ranges::none_of(scene.bodies, is_liquid)) {
    warn("/settling", "no body is liquid", warnings);
  }
  if (scene.sleeping && scene.vat && moves_walls(*scene.vat, 0)) {
    warn("/sleeping", "bodies do not sleep in a moving vat", warnings);
  }
  const auto is_moved = [](const BodyDescription& body) { return body.motion.has_value(); };
  if (scene.sleeping && std::ranges::any_of(scene.bodies, is_moved)) {
    warn("/sleeping", "bodies do not sleep beside a driven body", warnings);
  }
  warn_of_solver(scene, warnings);
  warn_of_tolerance(scene.numerics, warnings);
  warn_of_surfaces(scene, warnings);
  warn_of_friction(scene.default_interface, "/default_interface", warnings);
  for (std::size_t i = 0; i < scene.interfaces.size(); ++i) {
    const std::string path = "/interfaces/" + std::to_string(i);
    warn_of_friction(scene.interfaces[i].constants, path, warnings);
    warn_of_law(scene, scene.interfaces[i], path, warnings);
  }
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const BodyDescription& body = scene.bodies[b];
    const std::string path = body_path(b);
    if (body.seed != 0 && body.jitter == 0) {
      warn(path + "/seed", "the body has no jitter", warnings);
    }
    if (body.sub_steps > 1 && body.kind == BodyKind::liquid) {
      warn(path + "/sub_steps", "only solids take sub-steps", warnings);
    } else if (body.sub_steps > 1 && !may_be_local(scene.numerics)) {
      warn(path + "/sub_steps", "steps are not local", warnings);
    }
  }
}

}  // namespace vat
