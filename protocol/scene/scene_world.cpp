#include <array>

#include "core/limits.h"
#include "protocol/scene/scene_parts.h"

namespace vat::scene_parts {
namespace {

Wall to_wall(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Wall wall;
  wall.no_slip = reader.boolean("no_slip", wall.no_slip);
  wall.velocity = reader.vector("velocity", -kMaxSpeed, kMaxSpeed, wall.velocity);
  reader.refuse_unknown();
  return wall;
}

std::array<Wall, 6> to_walls(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  std::array<Wall, 6> walls;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    read_member(reader, kWallNames[i], walls[i], errors, to_wall);
  }
  reader.refuse_unknown();
  return walls;
}

void mark_axis(const Json& value, const std::string& path, std::array<bool, 3>& axes,
               Errors& errors) {
  constexpr std::size_t kNameLength = 1;
  if (!value.is_string()) {
    to_text(value, path, kNameLength, errors);
    return;
  }
  for (std::size_t axis = 0; axis < axes.size(); ++axis) {
    if (value.get_ref<const std::string&>() != kAxisNames[axis]) continue;
    if (axes[axis]) add_error(errors, "duplicate", path, "must not repeat an earlier axis");
    axes[axis] = true;
    return;
  }
  add_error(errors, "unknown_name", path, "must be one of \"x\", \"y\", \"z\"");
}

}  // namespace

SlideMotion to_motion(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  reader.choice("type", {"slide"});
  SlideMotion motion;
  motion.axis = reader.vector("axis", -kMaxLength, kMaxLength, motion.axis);
  motion.stroke = reader.real("stroke", -kMaxLength, kMaxLength);
  motion.period = reader.real("period", kAnyMin, kAnyMax, motion.period);
  reader.refuse_unknown();
  return motion;
}

Vat to_vat(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Vat vat;
  vat.min = reader.vector("min", -kMaxLength, kMaxLength);
  vat.max = reader.vector("max", -kMaxLength, kMaxLength);
  vat.lid = reader.boolean("lid", vat.lid);
  read_member(reader, "motion", vat.motion, errors, to_motion);
  read_member(reader, "walls", vat.walls, errors, to_walls);
  reader.refuse_unknown();
  return vat;
}

Periodicity to_periodicity(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Periodicity periodic;
  if (const Json* axes = reader.array("axes", periodic.axes.size(), true)) {
    for (std::size_t i = 0; i < axes->size(); ++i) {
      mark_axis((*axes)[i], pointer_to(reader.path_of("axes"), i), periodic.axes, errors);
    }
  }
  periodic.min = reader.vector("min", -kMaxLength, kMaxLength);
  periodic.max = reader.vector("max", -kMaxLength, kMaxLength);
  reader.refuse_unknown();
  return periodic;
}

CentralField to_central_field(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  CentralField field;
  field.center = reader.vector("center", -kMaxLength, kMaxLength, field.center);
  field.angular_frequency = reader.real("angular_frequency", 0, kMaxAngularSpeed);
  reader.refuse_unknown();
  return field;
}

Settling to_settling(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Settling settling;
  settling.drag = reader.real("drag", 0, kMaxDrag);
  settling.until = reader.real("until", 0, kMaxRelease);
  reader.refuse_unknown();
  return settling;
}

Sleeping to_sleeping(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Sleeping sleeping;
  sleeping.speed = reader.real("speed", kMinSleepSpeed, kMaxSleepSpeed, sleeping.speed);
  sleeping.after = reader.real("after", kMinStep, kMaxSleepAfter, sleeping.after);
  reader.refuse_unknown();
  return sleeping;
}

IncompressibleSolve to_incompressible(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  IncompressibleSolve solve;
  solve.density_tolerance = reader.real("density_tolerance", kMinVolumeTolerance,
                                        kMaxVolumeTolerance, solve.density_tolerance);
  solve.divergence_tolerance = reader.real("divergence_tolerance", kMinVolumeTolerance,
                                           kMaxVolumeTolerance, solve.divergence_tolerance);
  solve.most_iterations =
      static_cast<int>(reader.count("most_iterations", kMinIterations, kMaxIterations,
                                    static_cast<std::size_t>(solve.most_iterations)));
  reader.refuse_unknown();
  return solve;
}

ForceSwitches to_force_switches(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  ForceSwitches forces;
  forces.gravity = reader.boolean("gravity", forces.gravity);
  forces.pressure = reader.boolean("pressure", forces.pressure);
  forces.viscosity = reader.boolean("viscosity", forces.viscosity);
  forces.springs = reader.boolean("springs", forces.springs);
  forces.contacts = reader.boolean("contacts", forces.contacts);
  forces.walls = reader.boolean("walls", forces.walls);
  reader.refuse_unknown();
  return forces;
}

namespace {

std::optional<DeviceChoice> read_device(ObjectReader& reader, Errors& errors) {
  if (!reader.has("device")) return {};
  const Json* value = reader.member("device");
  if (!value->is_string()) {
    add_error(errors, "wrong_type", reader.path_of("device"), "must be a string");
    return {};
  }
  const Result<DeviceChoice> device = parse_device(value->get_ref<const std::string&>());
  if (device) return device.value();
  add_error(errors, "bad_value", reader.path_of("device"), device.errors().front().message);
  return {};
}

}  // namespace

Numerics to_numerics(const Json& value, std::string path, Errors& errors) {
  ObjectReader reader(value, std::move(path), errors);
  Numerics numerics;
  numerics.integrator = read_enum<IntegratorId>(reader, "integrator", numerics.integrator);
  numerics.step = reader.real("step", kMinStep, kMaxStep, numerics.step);
  numerics.tick = reader.real("tick", kMinStep, kMaxTick, numerics.tick);
  numerics.control = read_enum<StepControl>(reader, "control", numerics.control);
  numerics.tolerance = reader.real("tolerance", kMinAccuracy, kMaxTolerance, numerics.tolerance);
  if (reader.has("accuracy")) {
    numerics.accuracy = reader.real("accuracy", kMinAccuracy, kMaxAccuracy, kMaxAccuracy);
    for (const char* chosen : {"integrator", "step", "control", "tolerance"}) {
      if (!reader.has(chosen)) continue;
      add_error(errors, "not_allowed", reader.path_of(chosen),
                "must be left out beside \"accuracy\", which chooses it");
    }
  }
  numerics.device = read_device(reader, errors);
  reader.refuse_unknown();
  return numerics;
}

}  // namespace vat::scene_parts
