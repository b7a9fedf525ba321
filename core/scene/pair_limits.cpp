#include "core/scene/pair_limits.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>

#include "core/limits.h"
#include "core/neighbours/uniform_grid.h"
#include "core/scene/interface_table.h"

namespace vat {
namespace {

/// The bodies' particles one after the other.
struct Particles {
  std::vector<Vec3> positions;
  std::vector<std::uint8_t> is_liquid;
  std::vector<std::uint8_t> material;  // kMaxMaterials is 64
};

Particles gather(const std::vector<Material>& materials, const std::vector<PairBody>& bodies,
                 bool liquid_only) {
  Particles all;
  for (const PairBody& body : bodies) {
    const bool is_liquid = body.description->kind == BodyKind::liquid;
    if (liquid_only && !is_liquid) continue;
    const auto material =
        static_cast<std::uint8_t>(material_index(materials, body.description->material));
    all.positions.insert(all.positions.end(), body.positions.begin(), body.positions.end());
    all.is_liquid.insert(all.is_liquid.end(), body.positions.size(), is_liquid);
    all.material.insert(all.material.end(), body.positions.size(), material);
  }
  return all;
}

/// Whether more than max_start_pairs() of particles count, or more than kMaxSearch are tried.
/// `counts(i, j, r2)` tells whether j is one that i reaches.
template <class Counts>
bool too_many(const std::vector<Vec3>& points, Real reach, Counts&& counts) {
  const std::size_t most = max_start_pairs(points.size());
  std::size_t pairs = 0;
  std::size_t tried = 0;
  UniformGrid grid;
  grid.build(points, reach);
  for (Index i = 0; i < points.size() && pairs <= most && tried <= kMaxSearch; ++i) {
    grid.for_each_run(points[i], reach, [&](Index begin, Index end) {
      tried += end - begin;
      for (Index slot = begin; slot < end; ++slot) {
        const Index j = grid.order()[slot];
        if (j != i && counts(i, j, (points[i] - points[j]).squaredNorm())) ++pairs;
      }
    });
  }
  return pairs > most || tried > kMaxSearch;
}

std::string too_many_text(const std::string& what, Real reach, std::size_t particles) {
  char text[120];
  std::snprintf(text, sizeof text,
                " of %.4g m gives the %zu particles too many neighbours: at most %zu in all", reach,
                particles, max_start_pairs(particles));
  return what + text;
}

void check_liquid(const std::vector<Material>& materials, const std::vector<PairBody>& bodies,
                  const std::string& path, RangeCheck& check) {
  const Particles all = gather(materials, bodies, true);
  if (all.positions.empty()) return;
  std::vector<Real> support2(materials.size(), 0);
  std::size_t widest = all.material.front();
  for (const std::uint8_t m : all.material) {
    const Real support = materials[m].liquid->support_radius;
    support2[m] = support * support;
    if (support2[m] > support2[widest]) widest = m;
  }
  const Real reach = materials[widest].liquid->support_radius;
  const auto counts = [&](Index i, Index j, Real r2) {
    return all.material[i] == all.material[j] && r2 < support2[all.material[i]];
  };
  if (too_many(all.positions, reach, counts)) {
    check.add("too_many", path,
              too_many_text("the support radius of \"" + materials[widest].name + "\"", reach,
                            all.positions.size()));
  }
}

/// The greatest distance at which particles of two bodies touch, and what makes it so great.
struct ContactReach {
  Real distance = 0;
  std::string cause;
  bool liquids_touch = false;
};

ContactReach find_reach(const std::vector<Material>& materials,
                        const std::vector<InterfaceDescription>& interfaces,
                        const std::vector<PairBody>& bodies) {
  const InterfaceTable table(materials, interfaces);
  std::vector<Real> radius;
  std::vector<std::size_t> material;
  for (const PairBody& body : bodies) {
    radius.push_back(std::ranges::max(body.radii));
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
      take(has_threshold ? *interfaces[*interface].threshold : radius[a] + radius[b], [&] {
        return (has_threshold ? "the interface threshold of " : "the contact distance of ") +
               name(b) + " and " + name(a);
      });
    }
  }
  return reach;
}

void check_contacts(const std::vector<Material>& materials,
                    const std::vector<InterfaceDescription>& interfaces,
                    const std::vector<PairBody>& bodies, const std::string& path,
                    RangeCheck& check) {
  const ContactReach reach = find_reach(materials, interfaces, bodies);
  if (reach.distance == 0) return;
  const Particles all = gather(materials, bodies, false);
  const auto counts = [&](Index i, Index j, Real r2) {
    if (all.is_liquid[i] && all.is_liquid[j]) {
      return reach.liquids_touch && all.material[i] != all.material[j] &&
             r2 < reach.distance * reach.distance;
    }
    return r2 < reach.distance * reach.distance;
  };
  if (too_many(all.positions, reach.distance, counts)) {
    check.add("too_many", path, too_many_text(reach.cause, reach.distance, all.positions.size()));
  }
}

}  // namespace

void check_pairs(const std::vector<Material>& materials,
                 const std::vector<InterfaceDescription>& interfaces,
                 const std::vector<PairBody>& bodies, const std::string& path, RangeCheck& check) {
  check_liquid(materials, bodies, path, check);
  check_contacts(materials, interfaces, bodies, path, check);
}

}  // namespace vat
