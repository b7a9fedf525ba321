#include "core/numerics/pair_limits.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "core/kernels/cohesion_kernel.h"
#include "core/limits.h"
#include "core/neighbours/periodic_box.h"
#include "core/neighbours/uniform_grid.h"
#include "core/scene/interface_table.h"
#include "core/support/check.h"

namespace vat {
namespace {

PeriodicBox box_of(const Scene& scene) {
  return scene.periodic ? PeriodicBox(*scene.periodic) : PeriodicBox();
}

/// The particles of all bodies; in a periodic world, their images in its box.
struct Particles {
  std::vector<Vec3> positions;
  std::vector<std::uint8_t> material;  // kMaxMaterials is 64
};

Particles gather(const Scene& scene, const std::vector<PairBody>& bodies, bool liquid) {
  const PeriodicBox box = box_of(scene);
  Particles all;
  for (const PairBody& body : bodies) {
    if ((body.description->kind == BodyKind::liquid) != liquid) continue;
    const auto material =
        static_cast<std::uint8_t>(material_index(scene.materials, body.description->material));
    for (const Vec3& position : body.positions) all.positions.push_back(box.wrap(position));
    all.material.insert(all.material.end(), body.positions.size(), material);
  }
  return all;
}

Particles in_order(const Particles& particles, std::span<const Index> order) {
  Particles sorted;
  sorted.positions.reserve(order.size());
  sorted.material.reserve(order.size());
  for (const Index i : order) {
    sorted.positions.push_back(particles.positions[i]);
    sorted.material.push_back(particles.material[i]);
  }
  return sorted;
}

/// Counts neighbours by the search of a step, up to the limits. If `all_tried_count`, all tested
/// particles count, without a look at their distances.
class NeighbourCount {
 public:
  NeighbourCount(std::size_t particles, const PeriodicBox& box, bool all_tried_count)
      : most_(max_start_pairs(particles)), box_(box), all_tried_count_(all_tried_count) {}

  bool is_exceeded() const { return found_ > most_ || tried_ > kMaxSearch; }

  /// Adds the particles of `others` within `reach` of each of `particles`, itself included, for
  /// which `counts(material, other material, distance^2)` holds.
  template <class Counts>
  void add(const Particles& particles, const Particles& others, Real reach, Counts&& counts) {
    if (particles.positions.empty() || others.positions.empty()) return;
    UniformGrid grid;
    grid.build(others.positions, reach);
    Particles sorted;  // particles that are near in space are near in memory
    if (!all_tried_count_) sorted = in_order(others, grid.order());
    for (std::size_t i = 0; i < particles.positions.size() && !is_exceeded(); ++i) {
      box_.for_each_image(particles.positions[i], reach, [&](const Vec3& shift) {
        const Vec3 p = particles.positions[i] + shift;
        grid.for_each_run(p, reach, [&](Index begin, Index end) {
          tried_ += end - begin;
          if (all_tried_count_) found_ += end - begin;
          for (Index j = begin; j < end && !all_tried_count_; ++j) {
            const Real r2 = (p - sorted.positions[j]).squaredNorm();
            found_ += counts(particles.material[i], sorted.material[j], r2) ? 1 : 0;
          }
        });
      });
    }
  }

 private:
  std::size_t most_;
  PeriodicBox box_;
  bool all_tried_count_;
  std::size_t found_ = 0;
  std::size_t tried_ = 0;
};

/// Returns whether `add_all(count)` adds too many neighbours to a count. Distances are computed
/// only if the number of tested particles exceeds the limit.
template <class AddAll>
bool are_too_many(std::size_t particles, const PeriodicBox& box, AddAll&& add_all) {
  for (const bool all_tried_count : {true, false}) {
    NeighbourCount count(particles, box, all_tried_count);
    add_all(count);
    if (!count.is_exceeded()) return false;
  }
  return true;
}

std::string too_many_text(const std::string& what, Real reach, std::size_t particles) {
  char text[200];
  std::snprintf(text, sizeof text,
                " of %.4g m gives the %zu particles too many neighbours: at most %zu in all, found "
                "among at most %zu in the cells of that size around them",
                reach, particles, max_start_pairs(particles), kMaxSearch);
  return what + text;
}

/// The material of a liquid body with the largest support radius; empty without liquids.
std::optional<std::size_t> widest_liquid(const Scene& scene, const std::vector<PairBody>& bodies) {
  const auto support = [&](std::size_t m) { return scene.materials[m].liquid->support_radius; };
  std::optional<std::size_t> widest;
  for (const PairBody& body : bodies) {
    if (body.description->kind != BodyKind::liquid) continue;
    const std::size_t m = material_index(scene.materials, body.description->material);
    if (!widest || support(m) > support(*widest)) widest = m;
  }
  return widest;
}

std::string name_support(const Material& material) {
  return "the support radius of \"" + material.name + '"';
}

void check_liquid(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                  RangeCheck& check) {
  const auto widest = widest_liquid(scene, bodies);
  if (!widest) return;
  const Particles all = gather(scene, bodies, true);
  std::vector<Real> support2(scene.materials.size(), 0);
  for (std::size_t m = 0; m < support2.size(); ++m) {
    const auto& liquid = scene.materials[m].liquid;
    if (liquid) support2[m] = liquid->support_radius * liquid->support_radius;
  }
  const Real reach = scene.materials[*widest].liquid->support_radius;
  const auto add_all = [&](NeighbourCount& count) {
    count.add(all, all, reach, [&](std::size_t own, std::size_t other, Real r2) {
      return own == other && r2 < support2[own];
    });
  };
  if (are_too_many(all.positions.size(), box_of(scene), add_all)) {
    check.add("too_many", path,
              too_many_text(name_support(scene.materials[*widest]), reach, all.positions.size()));
  }
}

/// The maximum distance at which particles of two bodies touch, and its cause.
struct ContactReach {
  Real distance = 0;
  std::string cause;
  bool liquids_touch = false;
};

ContactReach find_reach(const Scene& scene, const std::vector<PairBody>& bodies) {
  const std::vector<Material>& materials = scene.materials;
  const std::vector<InterfaceDescription>& interfaces = scene.interfaces;
  if (!scene.forces.contacts) return {};
  const InterfaceTable table(materials, interfaces);
  std::vector<Real> radius;
  std::vector<std::size_t> material;
  for (const PairBody& body : bodies) {
    radius.push_back(body.radii.empty() ? 0 : std::ranges::max(body.radii));
    material.push_back(material_index(materials, body.description->material));
  }
  ContactReach reach;
  const auto take = [&](Real distance, auto&& cause) {
    if (distance <= reach.distance) return;
    reach.distance = distance;
    reach.cause = cause();
  };
  const auto name = [&](std::size_t b) { return '"' + bodies[b].description->name + '"'; };
  for (std::size_t a = 0; a < bodies.size(); ++a) {
    const bool is_liquid = bodies[a].description->kind == BodyKind::liquid;
    if (bodies[a].description->kind == BodyKind::deformable &&
        materials[material[a]].self_contact) {
      take(2 * radius[a], [&] { return "the self-contact of " + name(a) + " with radii"; });
    }
    for (std::size_t b = 0; b < a; ++b) {
      const bool both_liquid = is_liquid && bodies[b].description->kind == BodyKind::liquid;
      if (both_liquid && material[a] == material[b]) continue;
      reach.liquids_touch |= both_liquid;
      const auto interface = table.between(material[a], material[b]);
      const bool has_threshold = interface && interfaces[*interface].threshold;
      const InterfaceConstants& law =
          interface ? interfaces[*interface].constants : scene.default_interface;
      const Real touching =
          has_threshold ? *interfaces[*interface].threshold : radius[a] + radius[b];
      take(law.law == InterfaceLaw::lennard_jones ? law.reach * touching : touching, [&] {
        return (has_threshold ? "the interface threshold of " : "the contact distance of ") +
               name(b) + " and " + name(a);
      });
    }
  }
  return reach;
}

}  // namespace

void check_contact_pairs(const Scene& scene, const std::vector<PairBody>& bodies,
                         const std::string& path, RangeCheck& check) {
  const ContactReach reach = find_reach(scene, bodies);
  if (reach.distance == 0) return;
  const Particles solids = gather(scene, bodies, false);
  const Particles liquids = gather(scene, bodies, true);
  const std::size_t particles = solids.positions.size() + liquids.positions.size();
  const Real reach2 = reach.distance * reach.distance;
  const auto within = [&](std::size_t, std::size_t, Real r2) { return r2 < reach2; };
  const auto add_all = [&](NeighbourCount& count) {
    count.add(solids, solids, reach.distance, within);
    count.add(liquids, solids, reach.distance, within);
    if (!reach.liquids_touch) return;
    count.add(liquids, liquids, reach.distance, [&](std::size_t own, std::size_t other, Real r2) {
      return own != other && r2 < reach2;
    });
  };
  if (are_too_many(particles, box_of(scene), add_all)) {
    check.add("too_many", path, too_many_text(reach.cause, reach.distance, particles));
  }
}

namespace {

/// Adds an error if a particle could interact with another one and its image at once.
void check_length(const Periodicity& periodic, Real reach, const std::string& cause,
                  const std::string& path, RangeCheck& check) {
  for (std::size_t axis = 0; axis < periodic.axes.size(); ++axis) {
    const auto a = static_cast<Eigen::Index>(axis);
    if (!periodic.axes[axis] || periodic.max[a] - periodic.min[a] >= 2 * reach) continue;
    char text[120];
    std::snprintf(text, sizeof text, "the period along %s must be at least %.9g m, twice ",
                  kAxisNames[axis], 2 * reach);
    check.add("out_of_range", path, text + cause);
  }
}

}  // namespace

bool check_periods(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                   RangeCheck& check) {
  if (!scene.periodic) return true;
  Errors errors;
  RangeCheck own(errors);
  for (const PairBody& body : bodies) {
    if (body.description->kind != BodyKind::liquid) continue;
    const Material& material =
        scene.materials[material_index(scene.materials, body.description->material)];
    const bool attracts =
        scene.surface_model == SurfaceModel::cohesion && material.liquid->surface_tension > 0;
    const Real support = material.liquid->support_radius;
    const std::string cause =
        attracts ? "the attraction of \"" + material.name + '"' : name_support(material);
    check_length(*scene.periodic, attracts ? CohesionKernel::kReach * support : support, cause,
                 path, own);
    if (!errors.empty()) break;
  }
  const ContactReach reach = find_reach(scene, bodies);
  check_length(*scene.periodic, reach.distance, reach.cause, path, own);
  for (Error& error : errors) {
    check.add(std::move(error.code), std::move(error.path), std::move(error.message));
  }
  return errors.empty();
}

void check_pairs(const Scene& scene, const std::vector<PairBody>& bodies, const std::string& path,
                 RangeCheck& check) {
  check_liquid(scene, bodies, path, check);
  check_contact_pairs(scene, bodies, path, check);
}

void check_pairs_of_new(const Scene& scene, const std::vector<PairBody>& bodies,
                        const std::string& path, RangeCheck& check) {
  if (bodies.back().description->kind == BodyKind::liquid) {
    check_liquid(scene, bodies, path, check);
  }
  check_contact_pairs(scene, bodies, path, check);
}

namespace {

/// Returns whether particles of other bodies, for which `notices(body)` holds, may be within
/// `reach` of the body.
template <class Notices>
bool is_near_others(const std::vector<PairBody>& bodies, std::size_t body, Real reach,
                    Notices&& notices) {
  Eigen::AlignedBox<Real, 3> box;
  for (const Vec3& position : bodies[body].positions) box.extend(position);
  const Vec3 margin = Vec3::Constant(reach * (1 + 1e-6));
  const Eigen::AlignedBox<Real, 3> wide(box.min() - margin, box.max() + margin);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    if (b == body || !notices(*bodies[b].description)) continue;
    const auto is_near = [&](const Vec3& position) { return wide.contains(position); };
    if (std::ranges::any_of(bodies[b].positions, is_near)) return true;
  }
  return false;
}

}  // namespace

void check_pairs_of_moved(const Scene& scene, const std::vector<PairBody>& bodies, std::size_t body,
                          const std::string& path, RangeCheck& check) {
  VAT_CHECK(body < bodies.size());
  const BodyDescription& moved = *bodies[body].description;
  const bool is_liquid = moved.kind == BodyKind::liquid;
  const bool repeats = scene.periodic.has_value();  // images may be near
  if (is_liquid) {
    const Material& material = scene.materials[material_index(scene.materials, moved.material)];
    const auto is_same_liquid = [&](const BodyDescription& other) {
      return other.kind == BodyKind::liquid && other.material == moved.material;
    };
    if (repeats || is_near_others(bodies, body, material.liquid->support_radius, is_same_liquid)) {
      check_liquid(scene, bodies, path, check);
    }
  }
  const Real reach = find_reach(scene, bodies).distance;
  const auto is_any = [](const BodyDescription&) { return true; };
  if (reach > 0 && (repeats || is_near_others(bodies, body, reach, is_any))) {
    check_contact_pairs(scene, bodies, path, check);
  }
}

}  // namespace vat
