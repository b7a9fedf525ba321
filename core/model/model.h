#pragma once

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/kernels/cohesion_kernel.h"
#include "core/kernels/half_space.h"
#include "core/kernels/mueller_kernels.h"
#include "core/kernels/smoothing_kernel.h"
#include "core/neighbours/periodic_box.h"
#include "core/numerics/stable_step.h"
#include "core/sampling/nozzle.h"
#include "core/sampling/sampling.h"
#include "core/scene/scene.h"
#include "core/stage/plan.h"
#include "core/support/check.h"
#include "core/support/shared_array.h"
#include "core/types.h"

namespace vat {

/// A range of indices [begin, end).
struct IndexRange {
  Index begin = 0;
  Index end = 0;
  Index size() const { return end - begin; }
};

/// A nominal step that never comes.
inline constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

struct ModelBody {
  BodyId id = 0;
  std::string name;
  BodyKind kind = BodyKind::liquid;
  Index material = 0;
  IndexRange particles;
  Index rigid = 0;  ///< index among the rigid bodies; only for kind rigid
  Real mass = 0;
  std::uint64_t melts_at = kNever;            ///< the first nominal step in which it is liquid
  std::shared_ptr<const SampledBody> sample;  ///< null after forget_samples(), see sample_of()
  bool is_as_described = false;               ///< the sample follows from the description
};

/// The SPH constants of a material, with all values that depend on h only.
struct LiquidModel {
  /// `spacing`: that of the particles at rest density [m].
  LiquidModel(const Scene& scene, const Material& material, Real spacing);
  Real support_radius;
  Real rest_density;
  Real stiffness;
  Real pressure_share;  ///< factor of the pressure force of the gas: 1/2 as printed
  Real viscosity;
  Real surface_tension;  ///< [N/m]
  Poly6 density_kernel;
  Spiky pressure_kernel;
  ViscosityKernel viscosity_kernel;
  // Members of weakly compressible liquids:
  SmoothingKernel kernel;  ///< scaled so that a lattice with this spacing has the rest density
  Real spacing;
  Real slope_scale;  ///< scale of the kernel's gradient: exact for a linear field on this lattice
  Real central_viscosity;  ///< 2 (d + 2) mu, including the artificial viscosity [Pa s]
  Real tensile_strength;   ///< maximum tension of a cohesive liquid [Pa]
  HalfSpace half_space;
};

/// Dynamic connection between particles of two materials. It is a unilateral spring and dashpot
/// with l = threshold, which neither sticks nor changes the energy when it begins or ends; or a
/// layer; or a projection, without stiffness.
struct ContactLaw {
  Real stiffness = 0;         ///< [N/m]
  Real damping = 0;           ///< [N s/m]
  Real threshold = 0;         ///< 0: the sum of the radii, and at a wall the radius [m]
  Real friction = 0;          ///< coefficient mu
  Real damping_ratio = 0;     ///< for a restitution, in place of damping
  Real layer = 0;             ///< reach of a layer beyond the threshold, in thresholds
  bool is_projected = false;  ///< see core/contact/projection/projection.h
  Real restitution = 0;       ///< of a projection; separation speed / approach speed

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

/// A static spring with a maximum length.
struct LimitedSpring {
  Index a = 0;
  Index b = 0;
  Index end = 0;      ///< index of the spring end at a
  Real greatest = 0;  ///< maximum length [m]
};

/// A cell of a deformable body with a bulk modulus; see SampledCell.
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

  /// Returns whether the body moves in this step as if no force acted on it.
  bool is_held(std::uint64_t step) const { return step < free_from; }
};

/// The forces of a model that depend on velocities.
struct ModelDamping {
  bool any = false;
  std::vector<Oscillation> own;  ///< by body: of its springs, or of its liquid
  bool is_current = true;  ///< false: gravity has changed since, and with it the weight of liquids
};

/// A compiled scene, constant during steps. Large data of deformable bodies are shared by the
/// copies in which a command changes other data. Particles are ordered liquid, deformable, rigid,
/// each body contiguous. Deformable bodies with implicit springs are the last deformable ones.
struct Model {
  Scene scene;
  std::vector<ModelBody> bodies;  ///< in the scene's order

  PeriodicBox periodic;
  /// The walls of the vat that exist, numbered as in core/laws/vat_motion.h, and those of them
  /// without slip.
  std::vector<int> walls;
  std::vector<int> no_slip_walls;
  std::vector<Nozzle> nozzles;  ///< of the scene's emitters

  Index liquid_count = 0;    ///< particles [0, liquid_count) are liquid
  Index implicit_begin = 0;  ///< particles [implicit_begin, free_count) have implicit springs
  Index free_count = 0;      ///< particles [0, free_count) move on their own; the rest are rigid
  Index particle_count = 0;

  // One entry for each particle.
  std::vector<Real> mass;
  std::vector<Real> inverse_mass;  ///< 0: fixed, in a nozzle, or part of a rigid body
  std::vector<Real> radius;
  std::vector<Index> body;  ///< index into bodies
  std::vector<Index> material;
  /// Volume in a liquid at rest [m^3]; only for coupled liquids.
  std::vector<Real> rest_volume;
  std::vector<Vec3>
      local_position;  ///< rigid particles, from free_count on: about the centre of mass, body axes

  std::vector<std::optional<LiquidModel>> liquids;  ///< by material
  std::vector<RigidModel> rigid_bodies;

  // Static springs of free particles: the ends at particle i are [spring_begin[i],
  // spring_begin[i+1]), ordered by `other`. Springs to particles after i begin at
  // spring_own_begin[i].
  SharedArray<Index> spring_begin;
  SharedArray<Index> spring_own_begin;
  SharedArray<SpringEnd> spring_ends;
  // Cells of deformable bodies: corners at free particle i are [cell_begin[i], cell_begin[i+1]).
  SharedArray<VolumeCell> cells;
  SharedArray<Index> cell_begin;
  SharedArray<CellCorner> cell_corners;

  // By colour: two springs in [limited_begin[c], limited_begin[c + 1]) share no particle.
  SharedArray<LimitedSpring> limited_springs;
  SharedArray<Index> limited_begin;
  bool springs_change = false;  ///< some springs may flow or tear, see core/solid/spring_changes.h

  std::vector<ContactLaw> contact_laws;                       ///< materials x materials
  std::vector<ContactLaw> wall_laws;                          ///< by material
  std::vector<std::optional<SpringConstants>> self_contacts;  ///< by material
  // Pairs of particles of one deformable body that never collide: they are joined by a spring, or
  // start closer than their contact distance. Sorted. `exclusion_begin` has an entry for each free
  // particle, and the end.
  SharedArray<Index> exclusion_begin;
  SharedArray<Index> exclusions;
  Real contact_reach = 0;   ///< maximum distance of particles in contact [m]
  bool is_coupled = false;  ///< liquids interact with solids and walls by SPH, not by contacts
  bool is_filled = false;   ///< coupled, without a free surface: pressure may be negative
  bool is_incompressible = false;  ///< projections conserve the volume of coupled liquids
  bool liquids_touch = false;      ///< liquids of different materials are in contact
  bool has_self_contact = false;
  bool has_surface_tension = false;  ///< by curvature, of some liquid body
  std::vector<Real> wall_cosines;    ///< of the contact angle, by material; with curvature
  // Cohesive liquids, see core/liquid/surface/cohesion.h:
  std::optional<CohesionKernel> cohesion;  ///< if some liquid body has cohesion
  std::vector<Real> cohesions;             ///< A by material [Pa]
  /// Share of each liquid's attraction by the solids of each material, row by row; the walls are
  /// last in each row.
  std::vector<Real> adhesion_shares;
  // Properties of the laws of bodies and walls:
  bool has_friction = false;
  bool has_restitution = false;  ///< by dashpots
  bool has_layers = false;
  bool has_projection = false;
  // Whether some law exerts forces:
  bool bodies_push = false;
  bool walls_push = false;
  ModelDamping damping;

  StepPlan plan;

  /// The share for a liquid's material and the solids of another material, or the walls.
  Real adhesion_share(Index liquid, std::optional<Index> solid) const {
    VAT_ASSERT(liquid < scene.materials.size());
    const std::size_t count = scene.materials.size();
    return adhesion_shares[liquid * (count + 1) + solid.value_or(static_cast<Index>(count))];
  }
  const ContactLaw& contact_law(Index material_a, Index material_b) const {
    VAT_ASSERT(material_a < scene.materials.size() && material_b < scene.materials.size());
    return contact_laws[material_a * scene.materials.size() + material_b];
  }
};

}  // namespace vat
