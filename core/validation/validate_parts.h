#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/sampling/lattice.h"
#include "core/sampling/sampling.h"
#include "core/scene/material_members.h"
#include "core/scene/range_check.h"
#include "core/scene/scene.h"
#include "core/validation/validate.h"

/// Checks of the parts of a scene, for validate.cpp. Paths are JSON pointers.
namespace vat {

/// Checks the ranges of the numbers of a part of a material; see core/scene/material_members.h.
template <class Part>
void check_members(const Part& part, const std::string& path, RangeCheck& check) {
  for (const Member<Part>& member : kMembersOf<Part>) {
    const std::optional<Real> number = member.number_in(part);
    if (number) check.real(*number, member.min, member.max, path + '/' + member.name);
  }
}

/// Checks values, names and the threshold against the spacing of the bodies. Also checks whether
/// the law suits the bodies.
void check_interface(const Scene& scene, const InterfaceDescription& interface,
                     const std::string& path, RangeCheck& check);
/// Checks all interfaces of a scene.
void check_interfaces(const Scene& scene, RangeCheck& check);
/// Checks that a body to be added has no interface to another solid with a law for liquids.
void check_new_solid(const Scene& scene, const BodyDescription& body, const std::string& path,
                     RangeCheck& check);
/// Checks that the numerics support the law of an interface.
void check_law_numerics(const Numerics& numerics, const InterfaceConstants& constants,
                        const std::string& path, RangeCheck& check);

/// Checks the combination of the spring settings of a material.
void check_spring_changes(const Material& material, const std::string& path, RangeCheck& check);
/// Checks that the numerics support the spring settings of the materials.
void check_spring_numerics(const Scene& scene, RangeCheck& check);

/// Checks the sliding motion of the vat or of a driven body.
void check_slide(const SlideMotion& motion, const std::string& path, RangeCheck& check);
void check_vat(const Scene& scene, RangeCheck& check);
void check_periodicity(const Periodicity& periodic, RangeCheck& check);
void check_central_field(const CentralField& field, RangeCheck& check);
void check_settling(const Settling& settling, RangeCheck& check);
void check_sleeping(const Sleeping& sleeping, RangeCheck& check);
/// Checks emitters and drains.
void check_flow(const Scene& scene, Errors& errors);
void check_numerics(const Scene& scene, RangeCheck& check);
/// Checks that the accuracy of the scene, if given, can be reached. The scene must have no other
/// errors.
void check_accuracy(const Scene& scene, const std::vector<SampledBody>& samples, RangeCheck& check);

/// Checks that a two-dimensional scene, except its bodies, is in its plane. Code: off_plane.
void check_plane(const Scene& scene, RangeCheck& check);
void check_body_in_plane(const BodyDescription& body, const std::string& path, RangeCheck& check);

/// Budget of particles, springs and meshes for the bodies of a scene. A body that alone exceeds the
/// budget is not sampled. If the bodies together exceed the budget, sampling ends, because the
/// scene is invalid.
class Allowance {
 public:
  bool is_exceeded() const { return exceeded_; }
  std::size_t particles() const { return particles_; }
  std::size_t springs() const { return springs_; }

  /// Returns the reason why the mesh exceeds the budget, or null.
  const char* take_mesh(const MeshShape& mesh);
  /// Returns the reason why the lattice exceeds the budget, or null.
  const char* take_lattice(const Shape& shape, const Lattice& lattice);
  void take_particles(std::size_t count);
  void take_springs(std::size_t count);
  /// Adds an error if there are too many particles or springs.
  void check_totals(const std::string& path, RangeCheck& check) const;

 private:
  bool exceeded_ = false;
  std::size_t particles_ = 0;
  std::size_t springs_ = 0;
  std::size_t triangles_ = 0;
  Real lattice_points_ = 0;
  Real mesh_work_ = 0;
};

/// Checks that a body can melt into a material. `path` and `into_path` are the paths of the request
/// and of the name of the material.
void check_melting(const Scene& scene, const BodyDescription& body, const std::string& into,
                   const std::string& path, const std::string& into_path, RangeCheck& check);

/// Checks a body, except the uniqueness of its name and its relations to other bodies. Returns its
/// particles if it was sampled and has no errors.
std::optional<SampledBody> check_body(const Scene& scene, const Vec3& vat_offset,
                                      const BodyDescription& body, const std::string& path,
                                      Allowance& allowance, RangeCheck& check);

/// Returns whether a point is inside the walls of the vat. A vat has no walls across periodic axes.
bool is_inside_vat(const Scene& scene, const Vec3& point);
/// Checks that all positions are inside the walls of the vat, displaced by `offset` [m].
void check_inside_vat(const Scene& scene, const Vec3& offset, std::span<const Vec3> positions,
                      const std::string& path, RangeCheck& check);

/// Checks the initial position and motion of a body: their ranges, and whether the kind of body
/// supports them.
void check_motion(const BodyDescription& body, const std::string& path, RangeCheck& check);

/// Checks the effect of fields on the particles of a body.
void check_start(const BodyDescription& body, const SampledBody& sample, const std::string& path,
                 RangeCheck& check);

/// Checks the values of a shape, and whether a mesh can be filled with particles. Returns whether
/// the shape can be sampled.
bool check_shape(const BodyDescription& body, const std::string& path, RangeCheck& check);

/// Adds a warning with the code no_effect for each setting that has no effect in this scene.
void warn_of_idle_settings(const Scene& scene, std::vector<Warning>& warnings);

}  // namespace vat
