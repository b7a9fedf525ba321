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

/// Range of indices [begin, end).
struct IndexRange {
  Index begin = 0;
  Index end = 0;
  Index size() const { return end - begin; }
};

/// Step number that is never reached.
inline constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();

struct ModelBody {
  BodyId id = 0;
  std::string name;
  BodyKind kind = BodyKind::liquid;
  Index material = 0;
  IndexRange particles;
  Index rigid = 0;  ///< index among the rigid bodies; only for kind rigid
  Real mass = 0;
  /// Greatest distance of two places (Model::implicit_places) that a spring joins. Only for bodies
  /// with implicit springs that are narrow enough for BandFactor.
  std::optional<Index> spring_width;
  std::uint64_t melts_at = kNever;            ///< first nominal step in which the body is liquid
  std::shared_ptr<const SampledBody> sample;  ///< null after forget_samples(); see sample_of()
  bool is_as_described = false;               ///< sample can be computed from the description
};

/// SPH constants of a material, with all values that depend on h only.
struct LiquidModel {
  /// `spacing` is the particle spacing at rest density [m].
  LiquidModel(const Scene& scene, const Material& material, Real spacing);
  Real support_radius;
  Real rest_density;
  Real stiffness;
  Real pressure_share;  ///< factor of the gas pressure force; 1/2 in the article
  Real viscosity;
  Real surface_tension;  ///< [N/m]
  Poly6 density_kernel;
  Spiky pressure_kernel;
  ViscosityKernel viscosity_kernel;
  // Members of weakly compressible liquids:
  SmoothingKernel kernel;  ///< scaled: a lattice with this spacing has the rest density
  Real spacing;
  /// Scale of the kernel's gradient. With this scale, the gradient of a linear field on the lattice
  /// is exact.
  Real slope_scale;
  Real central_viscosity;  ///< 2 (d + 2) mu, including the artificial viscosity [Pa s]
  Real tensile_strength;   ///< maximum tension of a cohesive liquid [Pa]
  HalfSpace half_space;
};

/// Dynamic connection (contact) between particles of two materials. A connection is a unilateral
/// spring and dashpot with rest length l = threshold, a layer, or a projection without stiffness.
/// The unilateral spring is never attractive, and its energy is zero when the contact begins or
/// ends.
struct ContactLaw {
  Real stiffness = 0;  ///< [N/m]
  Real damping = 0;    ///< [N s/m]
  /// Distance at which the contact begins [m]. If 0, the distance is the sum of the radii, or the
  /// radius at a wall.
  Real threshold = 0;
  Real friction = 0;       ///< coefficient mu
  Real damping_ratio = 0;  ///< damping ratio for a restitution; replaces damping
  /// Reach of a layer beyond the threshold, in units of the threshold.
  Real layer = 0;
  bool is_projected = false;  ///< see core/contact/projection/projection.h
  Real restitution = 0;       ///< projection: separation speed / approach speed

  /// Returns the distance from a wall [m] below which a particle is in contact.
  Real wall_threshold(Real radius) const {
    return (threshold > 0 ? threshold : radius) * (1 + layer);
  }
};

/// Static connection (spring), as seen from one of its particles.
struct SpringEnd {
  Index other = 0;
  Real stiffness = 0;
  Real damping = 0;
  Real rest_length = 0;
};

/// Static spring with a maximum length.
struct LimitedSpring {
  Index a = 0;
  Index b = 0;
  Index end = 0;      ///< index of the spring end at particle a
  Real greatest = 0;  ///< maximum length [m]
};

/// Cell of a deformable body with a bulk modulus; see SampledCell.
struct VolumeCell {
  std::array<Index, 8> corners{};
  Real volume = 0;        ///< at rest [m^3]; in two dimensions [m^2]
  Real bulk_modulus = 0;  ///< [Pa]; in two dimensions [N/m]
};

/// Corner of a cell, as seen from the particle at this corner.
struct CellCorner {
  Index cell = 0;
  Index corner = 0;
};

struct RigidModel {
  Index body = 0;  ///< index into Model::bodies
  IndexRange particles;
  Real mass = 0;                     ///< [kg]
  Real inverse_mass = 0;             ///< of translations; 0 with an axle
  Mat3 inertia;                      ///< I_body about the centre of mass, in body axes [kg m^2]
  Mat3 inverse_inertia;              ///< in body axes; with an axle, of rotations about it only
  Quat principal_axes;               ///< rotation from principal to body axes
  Vec3 shape_origin = Vec3::Zero();  ///< see BodyView
  Vec3 inverse_moments;              ///< about the principal axes [1 / (kg m^2)]
  /// Order of the principal axes: the two with the closest moments of inertia, then the third.
  std::array<int, 3> splitting;
  std::uint64_t free_from = 0;          ///< first nominal step in which forces act on the body
  std::optional<SlideMotion> motion{};  ///< of a driven body, which is held
  std::optional<Axle> axle{};           ///< with a direction of length 1

  /// Returns whether the body is held in `step`. A held body moves as if no force acted on it.
  bool is_held(std::uint64_t step) const { return step < free_from; }
};

/// Velocity-dependent forces of a model.
struct ModelDamping {
  bool any = false;
  std::vector<Oscillation> own;         ///< by body: damping of its springs or its liquid
  std::vector<Oscillation> by_liquids;  ///< by solid body: by the forces of liquids on it
  /// False if gravity, and therefore the weight of liquids, has changed since `own` was computed.
  bool is_current = true;
};

/// A compiled scene, constant during steps. Copies of a model share the large arrays of deformable
/// bodies. The order of the particles is liquid, deformable, rigid, and the particles of each body
/// are contiguous. Deformable bodies with implicit springs are the last deformable bodies.
struct Model {
  Scene scene;
  std::vector<ModelBody> bodies;  ///< in the order of the scene

  PeriodicBox periodic;
  /// The existing walls of the vat, numbered as in core/laws/vat_motion.h, and the no-slip walls
  /// among them.
  std::vector<int> walls;
  std::vector<int> no_slip_walls;
  std::vector<Nozzle> nozzles;  ///< nozzles of the emitters of the scene

  Index liquid_count = 0;    ///< particles [0, liquid_count) are liquid
  Index implicit_begin = 0;  ///< particles [implicit_begin, free_count) have implicit springs
  Index free_count = 0;      ///< particles [0, free_count) are free; others are rigid
  Index particle_count = 0;

  // Members with one entry for each particle:
  std::vector<Real> mass;
  std::vector<Real> inverse_mass;  ///< 0: fixed, in a nozzle, or part of a rigid body
  std::vector<Real> radius;
  std::vector<Index> body;  ///< index into bodies
  std::vector<Index> material;
  /// Volume of the particle in a liquid at rest [m^3]. Only for coupled liquids.
  std::vector<Real> rest_volume;
  /// Positions of rigid particles relative to the centre of mass, in body axes [m]. The first entry
  /// belongs to particle free_count.
  std::vector<Vec3> local_position;

  std::vector<std::optional<LiquidModel>> liquids;  ///< indexed by material
  std::vector<RigidModel> rigid_bodies;

  // Static springs of free particles. The spring ends at particle i have the indices
  // [spring_begin[i], spring_begin[i+1]) and are ordered by `other`. Springs to particles after i
  // begin at spring_own_begin[i].
  SharedArray<Index> spring_begin;
  SharedArray<Index> spring_own_begin;
  SharedArray<SpringEnd> spring_ends;
  /// Order in which the springs of each body join near places. Indexed from particle
  /// implicit_begin.
  SharedArray<Index> implicit_places;
  // Cells of deformable bodies. The corners at free particle i are [cell_begin[i],
  // cell_begin[i+1]).
  SharedArray<VolumeCell> cells;
  SharedArray<Index> cell_begin;
  SharedArray<CellCorner> cell_corners;

  // Limited springs by colour. Two springs in [limited_begin[c], limited_begin[c + 1]) have no
  // common particle.
  SharedArray<LimitedSpring> limited_springs;
  SharedArray<Index> limited_begin;
  /// Whether some springs can flow plastically or tear; see core/solid/spring_changes.h.
  bool springs_change = false;

  std::vector<ContactLaw> contact_laws;                       ///< materials x materials
  std::vector<ContactLaw> wall_laws;                          ///< indexed by material
  std::vector<std::optional<SpringConstants>> self_contacts;  ///< indexed by material
  // Sorted pairs of particles of one deformable body that never collide. The particles of such a
  // pair are joined by a spring, or start closer than their contact distance. `exclusion_begin` has
  // one entry for each free particle, and one for the end.
  SharedArray<Index> exclusion_begin;
  SharedArray<Index> exclusions;
  Real contact_reach = 0;  ///< maximum distance of particles in contact [m]
  /// Whether SPH, not contacts, computes the interaction of liquids with solids and walls.
  bool is_coupled = false;
  /// Whether a coupled liquid has no free surface. Pressure may then be negative.
  bool is_filled = false;
  bool is_incompressible = false;  ///< projections conserve liquid volume
  bool liquids_touch = false;      ///< liquids of different materials are in contact
  bool has_self_contact = false;
  bool has_surface_tension = false;  ///< some liquid body has surface tension by curvature
  /// Cosines of the contact angles of walls, by material. Only for surface tension by curvature.
  std::vector<Real> wall_cosines;
  // Members of cohesive liquids; see core/liquid/surface/cohesion.h:
  std::optional<CohesionKernel> cohesion;  ///< only if some liquid body has cohesion
  std::vector<Real> cohesions;             ///< attraction A by material [Pa]
  /// Attraction of each liquid by the solids of each material, as a share of its attraction to
  /// itself. Each row belongs to a liquid; the last entry of a row belongs to the walls.
  std::vector<Real> adhesion_shares;
  // Whether any contact law of bodies or walls has these properties:
  bool has_friction = false;
  bool has_restitution = false;  ///< restitution by dashpots
  bool has_layers = false;
  bool has_projection = false;
  // Whether any contact law between bodies, or with walls, exerts forces:
  bool bodies_push = false;
  bool walls_push = false;
  ModelDamping damping;

  StepPlan plan;

  /// Returns the adhesion share of a liquid's material and the solids of a material. Without
  /// `solid`, the share is that of the walls.
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
