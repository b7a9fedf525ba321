#pragma once

#include <array>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/kernels/kernel_id.h"
#include "core/scene/pair_precision.h"
#include "core/types.h"

/// A scene as plain values: what a user writes. Nothing here is checked; see
/// core/validation/validate.h for the ranges and core/model/compile.h for what a scene becomes. SI
/// units throughout.
namespace vat {

enum class BodyKind : std::uint8_t { liquid = 0, deformable = 1, rigid = 2 };

enum class IntegratorId : std::uint8_t {
  explicit_euler,
  symplectic_euler,
  velocity_verlet,
  heun,
  runge_kutta_4,
};

/// How the length of steps is chosen; see core/stepping/step_control.h.
enum class StepControl : std::uint8_t {
  fixed,     ///< every step has the scene's length
  adaptive,  ///< the whole scene halves its step as often as the fastest process asks for
  local,     ///< each particle has its own power-of-two part of the step
};

/// What keeps a liquid's volume.
enum class PressureSolver : std::uint8_t {
  gas,   ///< Boldt eq. 14 with the kernels of [MCG03]; bodies and walls push with springs
  tait,  ///< weakly compressible, see core/liquid/tait/weakly_compressible.h; bodies and walls take
         ///< part
  incompressible,  ///< see core/liquid/incompressible/volume_solve.h; bodies and walls take part as
                   ///< in tait
};

/// What pulls a liquid's surface together.
enum class SurfaceModel : std::uint8_t {
  curvature,  ///< a force at the surface, see core/liquid/surface/surface_tension.h
  cohesion,   ///< attraction of all pairs, see core/liquid/surface/cohesion.h
};

/// How well the solves of an incompressible liquid keep its volume: relative changes of density,
/// means over its particles; one particle may be 36 times as much too dense, and its density change
/// 200 times as much.
struct IncompressibleSolve {
  Real density_tolerance = 5e-4;     ///< too dense at the end of a step
  Real divergence_tolerance = 1e-5;  ///< by the velocities within a step
  int most_iterations = 100;         ///< of each linear solve
};

/// A Hooke spring's constants: stiffness k [N/m] of Boldt eq. 3 and damping along the spring
/// [N s/m] (not in the paper; 0 is the paper's spring).
struct SpringConstants {
  Real stiffness = 0;
  Real damping = 0;
};

/// What two particles that meet by an interface do to each other.
enum class InterfaceLaw : std::uint8_t {
  /// A spring and dashpot along the line between them, which only push, and Coulomb friction across
  /// it; see core/laws/friction.h.
  penalty,
  lennard_jones,  ///< a layer that holds what touches it, see core/laws/lennard_jones.h
  sph,            ///< one of them is liquid: the other takes part in its density and pressure
  projection,     ///< what overlaps at the end of a step does not, see
                  ///< core/contact/projection/projection.h
};

/// What happens where bodies touch. Each law has constants of its own; the others stay as they are
/// here.
struct InterfaceConstants {
  Real stiffness = 0;  ///< [N/m] penalty; of a layer, where it neither pushes nor pulls
  Real damping = 0;    ///< [N s/m] penalty
  Real friction = 0;   ///< penalty and projection; coefficient mu, 0: surfaces are smooth
  InterfaceLaw law = InterfaceLaw::penalty;
  /// Speed of parting over speed of approach: penalty, in place of damping (see
  /// core/contact/restitution.h), and projection, where none is 0.
  std::optional<Real> restitution{};
  /// Of a layer: how far it reaches, in thresholds, at which it neither pushes nor pulls.
  Real reach = kDefaultReach;

  static constexpr Real kDefaultReach = 2;

  SpringConstants spring() const { return {stiffness, damping}; }
};

/// SPH constants of a liquid material.
struct LiquidConstants {
  Real stiffness = 0;       ///< k of Boldt eq. 14 [m^2/s^2], the square of the speed of sound
  Real viscosity = 0;       ///< dynamic viscosity mu [Pa s]
  Real support_radius = 0;  ///< h [m]: every kernel is zero at this distance
  /// alpha: adds alpha rho c h / (4 (d + 2)) to the viscosity of weakly compressible liquids, in d
  /// dimensions, which calms the sound of impacts.
  Real artificial_viscosity = 0.02;
  Real surface_tension = 0;  ///< sigma [N/m]; see core/liquid/surface/surface_tension.h
};

/// Static springs that the shape sampler puts between lattice neighbours of a deformable body:
/// structural along the axes, shear along face diagonals, bend between second neighbours along the
/// axes. An absent kind makes no springs.
struct LatticeSprings {
  std::optional<SpringConstants> structural;
  std::optional<SpringConstants> shear;
  std::optional<SpringConstants> bend;
};

/// How static springs flow (rate-independent: J. C. Simo, T. J. R. Hughes, Computational
/// Inelasticity, Springer, 1998, section 1.2 with linear kinematic hardening; with a relaxation
/// time: section 1.7). Strains are over a spring's length at rest at the start, l0: e of its
/// length, p of its present length at rest. It is elastic while |e - p - hardening p| <=
/// yield_strain.
struct Plasticity {
  Real yield_strain = 0;
  Real hardening = 0;        ///< plastic modulus over stiffness; 0: perfectly plastic
  Real relaxation_time = 0;  ///< of what is beyond yield [s]; 0: none ever is
  Real max_strain = 0.5;     ///< the greatest |p|
};

/// What bodies are made of. A body uses the parts that its kind needs.
struct Material {
  std::string name;
  Real density = 1000;                          ///< [kg/m^3]; rest density for a liquid
  std::optional<LiquidConstants> liquid;        ///< needed by liquid bodies
  std::optional<LatticeSprings> springs;        ///< used by sampled deformable bodies
  std::optional<SpringConstants> self_contact;  ///< dynamic springs within one deformable body
  /// Static springs are solved for, so that they limit no step; see
  /// core/solid/implicit_springs.h. Needs velocity Verlet, in fixed or adaptive steps.
  bool implicit_springs = false;
  std::optional<Plasticity> plasticity{};  ///< of static springs; they are elastic without
  std::optional<Real> tearing_strain{};    ///< static springs tear at this strain e, for good
  /// No static spring gets longer than 1 + this times its length at rest at the start; see
  /// core/solid/elongation_limit.h. Needs symplectic Euler or velocity Verlet, in fixed or
  /// adaptive steps, without implicit springs.
  std::optional<Real> elongation_limit{};
  /// K [Pa], in two dimensions [N/m]: cells of the lattice of sampled deformable bodies keep their
  /// volume, see core/solid/volume.h. 0: only springs resist compression.
  Real bulk_modulus = 0;
};

/// A box along the body's axes.
struct BoxShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Vec3 size = Vec3::Zero();    ///< whole edges [m]
};
/// A ball.
struct SphereShape {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real radius = 0;             ///< [m]
};
/// A solid circular cylinder with flat ends.
struct CylinderShape {
  Vec3 center = Vec3::Zero();  ///< of its volume [m]
  Vec3 axis = Vec3::UnitZ();   ///< any length but zero
  Real radius = 0;             ///< [m]
  Real height = 0;             ///< along the axis, from end to end [m]
};
/// Closed triangle mesh; triangles are counter-clockwise seen from outside.
struct MeshShape {
  std::string source;                           ///< where the mesh came from, for messages only
  std::vector<Vec3> vertices;                   ///< [m]
  std::vector<std::array<Index, 3>> triangles;  ///< indices of vertices
};
/// Particles one by one. `velocities`, `masses` and `radii` are empty or as long as `positions`;
/// empty masses: the body's mass in equal parts, or density times spacing cubed; empty radii: the
/// body's radius. `fixed` lists particles that never move (deformable bodies only).
struct ParticleShape {
  std::vector<Vec3> positions;   ///< [m]
  std::vector<Vec3> velocities;  ///< [m/s]
  std::vector<Real> masses;      ///< [kg]
  std::vector<Real> radii;       ///< [m]
  std::vector<Index> fixed;
};
using Shape = std::variant<BoxShape, SphereShape, CylinderShape, MeshShape, ParticleShape>;

/// One static connection (Boldt def. 0.2) between two particles of its body.
struct SpringDescription {
  Index a = 0;
  Index b = 0;
  SpringConstants constants;
  std::optional<Real> rest_length;  ///< l [m]; default: the distance at the start
};

/// A plane wave amplitude * sin(wave_vector . x + phase).
struct PlaneWave {
  Vec3 amplitude = Vec3::Zero();
  Vec3 wave_vector = Vec3::Zero();  ///< [rad/m]
  Real phase = 0;                   ///< [rad]
};

/// A vector at every point x of the world: gradient (x - center) + the sum of the waves.
struct VectorField {
  Vec3 center = Vec3::Zero();    ///< [m]
  Mat3 gradient = Mat3::Zero();  ///< row i: the derivatives of component i
  std::vector<PlaneWave> waves;
};

/// When a deformable body becomes liquid: as the first step begins that does so then or later.
struct Melting {
  std::string into;  ///< a material with liquid constants
  Real at = 0;       ///< [s]
};

/// One body. The shape is given in the body's own frame; `position` and `orientation` place that
/// frame in the world, `velocity` and `angular_velocity` (world axes, about the centre of mass) set
/// it in motion. Rigid bodies have neither fields nor jitter; only rigid bodies are held.
struct BodyDescription {
  std::string name;
  BodyKind kind = BodyKind::liquid;
  std::string material;
  Shape shape;
  Real spacing = 0;              ///< lattice spacing of the sampler [m]; unused by ParticleShape
  std::optional<Real> mass{};    ///< whole body [kg]; default: from the material's density
  std::optional<Real> radius{};  ///< particle radius [m]; default: half the spacing
  Vec3 position = Vec3::Zero();
  Quat orientation = Quat::Identity();
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  std::vector<SpringDescription> springs{};  ///< deformable bodies only, beside the lattice springs
  std::optional<VectorField> velocity_field{};      ///< [m/s] added to the particles' velocities
  std::optional<VectorField> displacement_field{};  ///< [m] added to their places, not to springs'
                                                    ///< default rest lengths
  Real jitter = 0;                                  ///< greatest random shift along each axis, in
                                                    ///< spacings
  std::uint32_t seed = 0;                           ///< of the jitter
  /// A held rigid body moves on as if no force acted on it, up to the time `release` [s].
  Real release = 0;
  bool fixed = false;                ///< held for ever
  std::optional<Melting> melting{};  ///< deformable bodies only
};

/// The name that stands for the vat's walls in an interface.
inline constexpr const char* kVatMaterial = "vat";

/// The contact angle [degrees] of walls that neither attract a liquid nor repel it.
inline constexpr Real kNeutralAngle = 90;

/// Interface (Boldt def. 0.6) between any two bodies of two materials, or a material and the vat's
/// walls: dynamic connections of rest length `threshold`, present while the distance is below it,
/// or below the reach of a layer.
struct InterfaceDescription {
  std::array<std::string, 2> materials;
  InterfaceConstants constants;
  std::optional<Real> threshold;  ///< [m]; default: the sum of the two particles' radii
  /// Of a liquid with surface tension on the vat's walls, measured in the liquid [degrees].
  Real contact_angle = kNeutralAngle;
};

/// Sliding along an axis and back: offset(t) = axis * stroke/2 * (1 - cos(2 pi t / period)).
struct SlideMotion {
  Vec3 axis = Vec3::UnitX();
  Real stroke = 0;  ///< greatest offset [m]
  Real period = 1;  ///< [s]
};

/// How a hand moves a vat beside its own motion: along each axis from where it was, at rest or not,
/// to its target, in the least time that kMaxHandSpeed and kMaxHandAcceleration allow, and there it
/// stays. Never in a scene that a user writes: see Simulation::move_vat().
struct HandMotion {
  Real start = 0;                ///< [s]
  Vec3 offset = Vec3::Zero();    ///< at the start [m]
  Vec3 velocity = Vec3::Zero();  ///< the same [m/s]
  Vec3 target = Vec3::Zero();    ///< [m]
};

/// Names of the axes, and of the vat's walls in the order of Vat::walls.
inline constexpr std::array<const char*, 3> kAxisNames{"x", "y", "z"};
inline constexpr std::array<const char*, 6> kWallNames{"x_min", "x_max", "y_min",
                                                       "y_max", "z_min", "z_max"};

/// What one wall of the vat does to what moves along it.
struct Wall {
  bool no_slip = false;          ///< the liquid at the wall has the wall's velocity
  Vec3 velocity = Vec3::Zero();  ///< of the wall's surface, along the wall [m/s]
};

/// An axis-aligned container with analytic walls, at `min`..`max` at time 0. Without a lid it is
/// open at +z and its side walls go up for ever. There are no walls across periodic axes.
struct Vat {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
  bool lid = false;
  std::optional<SlideMotion> motion;
  std::array<Wall, 6> walls{};  ///< x_min, x_max, y_min, y_max, z_min, z_max
  std::optional<HandMotion> hand{};
};

/// A world that repeats itself along some axes: what leaves through one side comes in through the
/// other, and particles near both sides are neighbours.
struct Periodicity {
  Vec3 min = Vec3::Zero();     ///< [m]; read along periodic axes only, as is max
  Vec3 max = Vec3::Zero();     ///< [m]
  std::array<bool, 3> axes{};  ///< which of x, y, z repeat
};

/// A field of acceleration -angular_frequency^2 (x - center), which pulls everything to a point.
struct CentralField {
  Vec3 center = Vec3::Zero();  ///< [m]
  Real angular_frequency = 0;  ///< [rad/s]
};

/// A drag on liquids towards the vat's velocity while a scene begins: liquid that was placed on a
/// lattice falls into its own balance with a sound that would ring for long.
struct Settling {
  Real drag = 0;   ///< by mass [1/s]; about c/H calms a depth H with a speed of sound c
  Real until = 0;  ///< time at which it ends [s]
};

/// When what has come to rest is no longer stepped; see core/sleep/islands.h. What moves more
/// slowly than that for so long is stopped.
struct Sleeping {
  Real speed = 0.01;  ///< of any particle [m/s]
  Real after = 0.5;   ///< how long all particles were slower [s]
};

/// A nozzle from which a liquid body grows: a tube of moving liquid that ends in an opening. In the
/// tube, which is as long as the liquid's support radius, layers of particles a spacing of the body
/// apart move with the nozzle's speed, whatever pushes them; at the opening they become free.
struct Emitter {
  std::string name;
  std::string body;              ///< the liquid body that grows; it has a spacing
  Vec3 position = Vec3::Zero();  ///< of the opening's centre [m]
  Vec3 direction{0, 0, -1};      ///< of the flow; any length but zero
  std::optional<Real> radius{};  ///< of a round opening [m]; in the plane half its width
  /// Edges of a rectangular one [m], the first horizontal, along x where the flow is vertical.
  std::optional<std::array<Real, 2>> size{};
  Real speed = 0;                  ///< [m/s]
  Real from = 0;                   ///< when the flow reaches the opening [s]
  Real until = kNoEnd;             ///< the first time without flow [s]
  std::size_t most_particles = 0;  ///< of the body: a layer that would be more is left out
  bool open = true;                ///< no layer comes into the tube of a closed one

  static constexpr Real kNoEnd = 1e9;
};

/// A box from which liquid is taken as the first step of each tick begins.
struct Drain {
  std::string name;
  Vec3 min = Vec3::Zero();  ///< [m]
  Vec3 max = Vec3::Zero();  ///< [m]
};

/// Forces that act; one that is off costs nothing.
struct ForceSwitches {
  bool gravity = true;    ///< and the central field
  bool pressure = true;   ///< of liquids
  bool viscosity = true;  ///< of liquids, at no-slip walls too
  bool springs = true;    ///< static connections
  bool contacts = true;   ///< dynamic connections between particles
  bool walls = true;      ///< of the vat
};

/// `tick` is the interval at which a server applies commands and publishes frames; it is a whole
/// number of steps.
struct Numerics {
  IntegratorId integrator = IntegratorId::velocity_verlet;
  Real step = 1e-3;  ///< dt [s]; of varied steps the greatest
  Real tick = 0.02;  ///< [s]
  StepControl control = StepControl::fixed;
  /// Of varied steps: the phase error per radian, relative, of the motion that they resolve.
  Real tolerance = 0.01;
  /// The relative error that integrator, step, control and tolerance are chosen for, in place of
  /// those given here; see core/numerics/choose_numerics.h.
  std::optional<Real> accuracy{};
};

/// All that a simulation starts from.
struct Scene {
  std::string name;
  std::string title;
  std::string description;
  Vec3 gravity{0, 0, -9.81};  ///< [m/s^2]
  std::vector<Material> materials;
  std::vector<InterfaceDescription> interfaces;
  InterfaceConstants default_interface{1000, 1};  ///< for pairs that `interfaces` does not list
  std::vector<BodyDescription> bodies;
  std::optional<Vat> vat;
  std::optional<Periodicity> periodic;
  std::optional<CentralField> central_field;
  std::optional<Settling> settling;
  std::optional<Sleeping> sleeping;  ///< nothing ever sleeps without
  std::vector<Emitter> emitters;
  std::vector<Drain> drains;
  ForceSwitches forces;
  PressureSolver pressure_solver = PressureSolver::tait;
  IncompressibleSolve incompressible;  ///< used by that solver
  /// Of the gas: half of the pressure force, as Boldt and [MCG03] print it, for comparison.
  bool printed_pressure_force = false;
  KernelId kernel = KernelId::wendland_c2;  ///< of liquids; the gas has those of [MCG03]
  /// Of liquids' sums over pairs; the gas has double precision.
  PairPrecision pair_precision = PairPrecision::single_precision;
  SurfaceModel surface_model = SurfaceModel::curvature;
  /// 3, or 2: everything stays in the plane y = 0, kernels and sampled masses are those of two
  /// dimensions, and masses, forces and energies are per metre of depth.
  int dimensions = 3;
  Numerics numerics;
};

/// Names used in scene files, messages and tables.
const char* to_string(BodyKind kind);
const char* to_string(IntegratorId id);
const char* to_string(StepControl control);
const char* to_string(PressureSolver solver);
const char* to_string(InterfaceLaw law);
const char* to_string(KernelId id);
const char* to_string(PairPrecision precision);
const char* to_string(SurfaceModel model);

}  // namespace vat
