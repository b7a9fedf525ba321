#include <bit>
#include <type_traits>

#include "tests/unit/scene_json_cases.h"

namespace vat::scene_cases {
namespace {

/// Writes every member of a scene. Each struct is taken apart by a structured binding, so that a
/// member added to it and forgotten here does not compile.
class BitWriter {
 public:
  std::string take() { return std::move(text_); }

  void put(Real value) { put_number(std::bit_cast<std::uint64_t>(value)); }
  void put(Index value) { put_number(value); }
  void put(int value) { put_number(static_cast<std::uint64_t>(value)); }
  void put(bool value) { put_number(value ? 1 : 0); }
  void put(const std::string& value) { text_ += '"' + value + "\"\n"; }
  void put(const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) put(value[axis]);
  }
  void put(const Quat& value) {
    put(value.w());
    put(Vec3(value.vec()));
  }
  template <class T>
  void put(const std::optional<T>& value) {
    put(value.has_value());
    if (value) put(*value);
  }
  template <class T>
  void put(const std::vector<T>& values) {
    put_number(values.size());
    for (const T& value : values) put(value);
  }
  template <class T, std::size_t n>
  void put(const std::array<T, n>& values) {
    for (const T& value : values) put(value);
  }
  template <class Enum>
  requires std::is_enum_v<Enum>
  void put(Enum value) { put_number(static_cast<std::uint64_t>(value)); }

  void put(const SpringConstants& constants) {
    const auto& [stiffness, damping] = constants;
    put_all(stiffness, damping);
  }
  void put(const InterfaceConstants& constants) {
    const auto& [stiffness, damping, friction, law, restitution, reach] = constants;
    put_all(stiffness, damping, friction, law, restitution, reach);
  }
  void put(const LiquidConstants& liquid) {
    const auto& [stiffness, viscosity, support_radius, artificial_viscosity, surface_tension] =
        liquid;
    put_all(stiffness, viscosity, support_radius, artificial_viscosity, surface_tension);
  }
  void put(const LatticeSprings& springs) {
    const auto& [structural, shear, bend] = springs;
    put_all(structural, shear, bend);
  }
  void put(const Plasticity& plasticity) {
    const auto& [yield_strain, hardening, relaxation_time, max_strain] = plasticity;
    put_all(yield_strain, hardening, relaxation_time, max_strain);
  }
  void put(const Material& material) {
    const auto& [name, density, liquid, springs, self_contact, implicit_springs, plasticity,
                 tearing_strain, elongation_limit, bulk_modulus] = material;
    put_all(name, density, liquid, springs, self_contact, implicit_springs, plasticity,
            tearing_strain, elongation_limit, bulk_modulus);
  }
  void put(const InterfaceDescription& interface) {
    const auto& [materials, constants, threshold, contact_angle] = interface;
    put_all(materials, constants, threshold, contact_angle);
  }
  void put(const SlideMotion& motion) {
    const auto& [axis, stroke, period] = motion;
    put_all(axis, stroke, period);
  }
  void put(const Wall& wall) {
    const auto& [no_slip, velocity] = wall;
    put_all(no_slip, velocity);
  }
  void put(const Vat& vat) {
    const auto& [min, max, lid, motion, walls, hand] = vat;  // a hand is in no scene file
    put_all(min, max, lid, motion, walls);
  }
  void put(const Periodicity& periodic) {
    const auto& [min, max, axes] = periodic;
    put_all(min, max, axes);
  }
  void put(const CentralField& field) {
    const auto& [center, angular_frequency] = field;
    put_all(center, angular_frequency);
  }
  void put(const Settling& settling) {
    const auto& [drag, until] = settling;
    put_all(drag, until);
  }
  void put(const Sleeping& sleeping) {
    const auto& [speed, after] = sleeping;
    put_all(speed, after);
  }
  void put(const IncompressibleSolve& solve) {
    const auto& [density_tolerance, divergence_tolerance, most_iterations] = solve;
    put_all(density_tolerance, divergence_tolerance, most_iterations);
  }
  void put(const ForceSwitches& forces) {
    const auto& [gravity, pressure, viscosity, springs, contacts, walls] = forces;
    put_all(gravity, pressure, viscosity, springs, contacts, walls);
  }
  void put(const PlaneWave& wave) {
    const auto& [amplitude, wave_vector, phase] = wave;
    put_all(amplitude, wave_vector, phase);
  }
  void put(const VectorField& field) {
    const auto& [center, gradient, waves] = field;
    put_all(center, Vec3(gradient.col(0)), Vec3(gradient.col(1)), Vec3(gradient.col(2)), waves);
  }
  void put(const Numerics& numerics) {
    const auto& [integrator, step, tick, control, tolerance, accuracy] = numerics;
    put_all(integrator, step, tick, control, tolerance, accuracy);
  }
  void put(const BoxShape& box) {
    const auto& [center, size] = box;
    put_all(center, size);
  }
  void put(const SphereShape& sphere) {
    const auto& [center, radius] = sphere;
    put_all(center, radius);
  }
  void put(const CylinderShape& cylinder) {
    const auto& [center, axis, radius, height] = cylinder;
    put_all(center, axis, radius, height);
  }
  void put(const MeshShape& mesh) {
    const auto& [source, vertices, triangles] = mesh;
    put_all(source, vertices, triangles);
  }
  void put(const ParticleShape& particles) {
    const auto& [positions, velocities, masses, radii, fixed] = particles;
    put_all(positions, velocities, masses, radii, fixed);
  }
  void put(const Shape& shape) {
    put_number(shape.index());
    std::visit([this](const auto& form) { put(form); }, shape);
  }
  void put(const SpringDescription& spring) {
    const auto& [a, b, constants, rest_length] = spring;
    put_all(a, b, constants, rest_length);
  }
  void put(const Emitter& emitter) {
    const auto& [name, body, position, direction, radius, size, speed, from, until, most, open] =
        emitter;
    put_all(name, body, position, direction, radius, size, speed, from, until, open);
    put_number(most);
  }
  void put(const Drain& drain) { put_all(drain.name, drain.min, drain.max); }
  void put(const Melting& melting) { put_all(melting.into, melting.at); }
  void put(const BodyDescription& body) {
    const auto& [name, kind, material, shape, spacing, mass, radius, position, orientation,
                 velocity, angular_velocity, springs, velocity_field, displacement_field, jitter,
                 seed, release, fixed, melting] = body;
    put_all(name, kind, material, shape, spacing, mass, radius, position, orientation, velocity,
            angular_velocity, springs, velocity_field, displacement_field, jitter, seed, release,
            fixed, melting);
  }
  void put(const Scene& scene) {
    const auto& [name, title, description, gravity, materials, interfaces, default_interface,
                 bodies, vat, periodic, central_field, settling, sleeping, emitters, drains, forces,
                 pressure_solver, incompressible, printed_pressure_force, kernel, pair_precision,
                 surface_model, dimensions, numerics] = scene;
    put_all(name, title, description, gravity, materials, interfaces, default_interface, bodies,
            vat, periodic, central_field, settling, sleeping, emitters, drains, forces,
            pressure_solver, incompressible, printed_pressure_force, kernel, pair_precision,
            surface_model, dimensions, numerics);
  }

 private:
  template <class... Values>
  void put_all(const Values&... values) {
    (put(values), ...);
  }
  void put_number(std::uint64_t value) { text_ += std::to_string(value) + '\n'; }

  std::string text_;
};

}  // namespace

std::string bits_of(const Scene& scene) {
  BitWriter writer;
  writer.put(scene);
  return writer.take();
}

}  // namespace vat::scene_cases
