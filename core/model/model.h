#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/cohesion_kernel.h"
#include "core/kernels/half_space.h"
#include "core/kernels/poly6.h"
#include "core/kernels/smoothing_kernel.h"
#include "core/kernels/spiky.h"
#include "core/kernels/viscosity_kernel.h"
#include "core/neighbours/periodic_box.h"
#include "core/numerics/stable_step.h"
#include "core/sampling/nozzle.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"
#include "core/stage/plan.h"
#include "core/support/shared_array.h"
#include "core/types.h"

namespace vat {

/// A range of indices [begin, end).
struct IndexRange {
  Index begin = 0;
  Index end = 0;
  Index size() const { return end - begin; }
};

/// Of nominal steps.
inline constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

struct ModelBody {
  BodyId id = 0;
  std::string name;
  BodyKind kind = BodyKind::liquid;
  Index material = 0;
  IndexRange particles;
  Index rigid = 0;  ///< place among the rigid bodies; only for kind rigid
  Real mass = 0;
  std::uint64_t melts_at = kNever;            ///< the first nominal step in which it is liquid
  std::shared_ptr<const SampledBody> sample;  ///< null once forgotten, see sample_of()
  bool is_as_described = false;               ///< the sample is what the description gives
};

/// One material's SPH constants with everything that depends on h alone.
struct LiquidModel {
  /// `spacing`: of the particles at rest density [m].
  LiquidModel(const Scene& scene, const Material& material, Real spacing);
  Real support_radius;
  Real rest_density;
  Real stiffness;
  Real pressure_share;  ///< of the gas's pressure force: 1/2 as printed
  Real viscosity;
  Real surface_tension;  ///< [N/m]
  Poly6 density_kernel;
  Spiky pressure_kernel;
  ViscosityKernel viscosity_kernel;
  // Of the weakly compressible liquid.
  SmoothingKernel kernel;  ///< scaled so that a lattice of that spacing has the rest density
  Real spacing;
  Real slope_scale;  ///< of that kernel, so that a slope over that lattice has its own steepness
  Real central_viscosity;  ///< 2 (d + 2) mu, with the artificial one [Pa s]
  Real tensile_strength;   ///< the greatest tension of a liquid that attracts itself [Pa]
  HalfSpace half_space;
};

/// Dynamic connection between particles of two materials: unilateral spring and dashpot with
/// l = threshold, so that it neither sticks nor jumps in energy when it comes and goes; or a layer;
/// or, with no stiffness, a projection.
struct ContactLaw {
  Real stiffness = 0;         ///< [N/m]
  Real damping = 0;           ///< [N s/m]
  Real threshold = 0;         ///< [m]; 0 means the sum of the radii (against a wall: the radius)
  Real friction = 0;          ///< coefficient mu
  Real damping_ratio = 0;     ///< of what has a restitution, in place of damping
  Real layer = 0;             ///< how far a layer reaches beyond the threshold, in thresholds
  bool is_projected = false;  ///< see core/contact/projection/projection.h
  Real restitution = 0;       ///< of a projection

  /// The distance from a wall below which a particle is in contact [m].
  Real wall_threshold(Real radius) const {
    return (threshold > 0 ? threshold : radius) * (1 + layer);
  }
};

/// A static connection seen from one of its particles.
struct SpringEnd {
  Index other = 0;
  Real stiffness = 0;
  Real damping = 0;
  Real rest_length = 0;
};

/// A static spring that gets no longer than `greatest`.
struct LimitedSpring {
  Index a = 0;
  Index b = 0;
  Index end = 0;      ///< that at a
  Real greatest = 0;  ///< [m]
};

/// A cell of a deformable body that keeps its volume; see SampledCell.
struct VolumeCell {
  std::array<Index, 8> corners{};
  Real volume = 0;        ///< at rest [m^3], in two dimensions [m^2]
  Real bulk_modulus = 0;  ///< [Pa], in two dimensions [N/m]
};

/// A cell seen from one of its particles.
struct CellCorner {
  Index cell = 0;
  Index corner = 0;
};

struct RigidModel {
  Index body = 0;  ///< index into Model::bodies
  IndexRange particles;
  Real inverse_mass = 0;
  Mat3 inertia;                  ///< I_body about the centre of mass, in body axes [kg m^2]
  Mat3 inverse_inertia;          ///< in body axes
  Quat principal_axes;           ///< principal to body axes
  Vec3 inverse_moments;          ///< about the principal axes [1 / (kg m^2)]
  std::array<int, 3> splitting;  ///< principal axes: two with the closest moments, and the third
  std::uint64_t free_from = 0;   ///< the first nominal step in which forces move it

  /// Whether the body moves through this step as if no force acted on it.
  bool is_held(std::uint64_t step) const { return step < free_from; }
};

/// The forces of a model that depend on velocities.
struct ModelDamping {
  bool any = false;
  std::vector<Oscillation> own;  ///< by body: of its springs, or of its liquid
  bool is_current = true;        ///< not for the weight of liquids once gravity has changed
};

/// A compiled scene: constant while it is stepped. What is large for deformable bodies is shared by
/// the copies in which a command changes something else. Particles are ordered liquid, deformable,
/// rigid, each body contiguous; of the deformable ones, those with implicit springs come last.
struct Model {
  Scene scene;
  std::vector<ModelBody> bodies;  ///< in the scene's order

  PeriodicBox periodic;
  /// The vat's walls, by the numbers of core/laws/vat_motion.h: those that the scene has, and of
  /// them those that are no_slip.
  std::vector<int> walls;
  std::vector<int> no_slip_walls;
  std::vector<Nozzle> nozzles;  ///< of the scene's emitters

  Index liquid_count = 0;    ///< particles [0, liquid_count) are liquid
  Index implicit_begin = 0;  ///< particles [implicit_begin, free_count) have implicit springs
  Index free_count = 0;      ///< particles [0, free_count) move on their own; the rest are rigid
  Index particle_count = 0;

  // One entry a particle.
  std::vector<Real> mass;
  std::vector<Real> inverse_mass;  ///< 0: fixed, in a nozzle, or part of a rigid body
  std::vector<Real> radius;
  std::vector<Index> body;  ///< index into bodies
  std::vector<Index> material;
  /// In a liquid at rest [m^3]; where solids and walls take part in liquids (is_coupled).
  std::vector<Real> rest_volume;
  std::vector<Vec3> local_position;  ///< rigid particles, from free_count on: body axes, about cm

  std::vector<std::optional<LiquidModel>> liquids;  ///< by material
  std::vector<RigidModel> rigid_bodies;

  // Static springs of free particles: ends of particle i are [spring_begin[i], spring_begin[i+1]),
  // in order of `other`, those to later particles from spring_own_begin[i] on.
  SharedArray<Index> spring_begin;
  SharedArray<Index> spring_own_begin;
  SharedArray<SpringEnd> spring_ends;
  // Cells of deformable bodies: corners at free particle i are [cell_begin[i], cell_begin[i+1]).
  SharedArray<VolumeCell> cells;
  SharedArray<Index> cell_begin;
  SharedArray<CellCorner> cell_corners;

  // By colour: none of [limited_begin[c], limited_begin[c + 1]) shares a particle with another.
  SharedArray<LimitedSpring> limited_springs;
  SharedArray<Index> limited_begin;
  bool springs_change = false;  ///< some may flow or tear, see core/solid/spring_changes.h

  std::vector<ContactLaw> contact_laws;                       ///< materials x materials
  std::vector<ContactLaw> wall_laws;                          ///< by material
  std::vector<std::optional<SpringConstants>> self_contacts;  ///< by material
  // Pairs of one deformable body that never collide: joined by a spring, or closer at the start
  // than they may come. Sorted; begins have an entry per free particle and one more.
  SharedArray<Index> exclusion_begin;
  SharedArray<Index> exclusions;
  Real contact_reach = 0;   ///< [m] no contact between particles further apart than this
  bool is_coupled = false;  ///< liquids meet solids and walls by SPH, not by contacts
  bool is_filled = false;   ///< coupled, and without a free surface: pressure may be negative
  bool is_incompressible = false;  ///< coupled liquids keep their volume by projections
  bool liquids_touch = false;      ///< two liquid materials meet, so liquid particles collide
  bool has_self_contact = false;
  bool has_surface_tension = false;  ///< some liquid body has, by its curvature
  std::vector<Real> wall_cosines;    ///< by material, of the contact angle; the same
  // Of liquids that attract themselves, see core/liquid/surface/cohesion.h.
  std::optional<CohesionKernel> cohesion;  ///< where some liquid body does
  std::vector<Real> cohesions;             ///< A by material [Pa]
  /// Shares of materials, row by row, in what solids of others pull, the walls last in each.
  std::vector<Real> adhesion_shares;
  // Whether some law of bodies or walls has it.
  bool has_friction = false;
  bool has_restitution = false;  ///< by dashpots
  bool has_layers = false;
  bool has_projection = false;
  // Whether not all laws are projections.
  bool bodies_push = false;
  bool walls_push = false;
  ModelDamping damping;

  StepPlan plan;

  /// Of a liquid's material and solids of another, or with no other walls.
  Real adhesion_share(Index liquid, std::optional<Index> solid) const {
    const std::size_t count = scene.materials.size();
    return adhesion_shares[liquid * (count + 1) + solid.value_or(static_cast<Index>(count))];
  }
  const ContactLaw& contact_law(Index material_a, Index material_b) const {
    return contact_laws[material_a * scene.materials.size() + material_b];
  }
};

}  // namespace vat
