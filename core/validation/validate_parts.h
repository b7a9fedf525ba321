#pragma once

#include <optional>
#include <span>
#include <string>

#include "core/sampling/lattice.h"
#include "core/sampling/sampling.h"
#include "core/scene/range_check.h"
#include "core/scene/scene.h"

/// The checks of validate.cpp for the parts of a scene, one by one. Paths are JSON pointers.
namespace vat {

void check_constants(const SpringConstants& constants, const std::string& path, RangeCheck& check);

/// Values, names, the threshold against the spacing of the bodies that it joins, and whether its
/// law is one for them.
void check_interface(const Scene& scene, const InterfaceDescription& interface,
                     const std::string& path, RangeCheck& check);
/// All of a scene's.
void check_interfaces(const Scene& scene, RangeCheck& check);
/// That a body to be added meets no other solid by a law for liquids.
void check_new_solid(const Scene& scene, const BodyDescription& body, const std::string& path,
                     RangeCheck& check);
/// That the numerics can have such an interface.
void check_law_numerics(const Numerics& numerics, const InterfaceConstants& constants,
                        const std::string& path, RangeCheck& check);

/// Of a material: what may become of static springs.
void check_spring_changes(const Material& material, const std::string& path, RangeCheck& check);
/// That the numerics fit what materials say of static springs.
void check_spring_numerics(const Scene& scene, RangeCheck& check);

void check_vat(const Scene& scene, RangeCheck& check);
void check_periodicity(const Periodicity& periodic, RangeCheck& check);
void check_central_field(const CentralField& field, RangeCheck& check);
void check_settling(const Settling& settling, RangeCheck& check);
void check_sleeping(const Sleeping& sleeping, RangeCheck& check);
/// Of emitters and drains.
void check_flow(const Scene& scene, Errors& errors);
void check_numerics(const Numerics& numerics, RangeCheck& check);
/// Whether the accuracy, if any, can be met. The rest of the scene must be without errors.
void check_accuracy(const Scene& scene, const std::vector<SampledBody>& samples, RangeCheck& check);

/// That a scene of two dimensions, but its bodies, stays in its plane. Code: off_plane.
void check_plane(const Scene& scene, RangeCheck& check);
void check_body_in_plane(const BodyDescription& body, const std::string& path, RangeCheck& check);

/// What may be spent on a scene's bodies. A body that is too much by itself is not sampled; one
/// that is too much together with those before it ends the sampling, since one excess is enough to
/// refuse the scene.
class Allowance {
 public:
  bool is_exceeded() const { return exceeded_; }
  std::size_t particles() const { return particles_; }
  std::size_t springs() const { return springs_; }

  /// Why the mesh cannot be looked at; null if it can.
  const char* take_mesh(const MeshShape& mesh);
  /// Why the lattice cannot be filled; null if it can.
  const char* take_lattice(const Shape& shape, const Lattice& lattice);
  void take_particles(std::size_t count);
  void take_springs(std::size_t count);
  /// Adds an error where there are too many particles or springs.
  void check_totals(const std::string& path, RangeCheck& check) const;

 private:
  bool exceeded_ = false;
  std::size_t particles_ = 0;
  std::size_t springs_ = 0;
  std::size_t triangles_ = 0;
  Real lattice_points_ = 0;
  Real mesh_work_ = 0;
};

/// That a body has what it takes to become liquid of a material. The paths are those of what asks
/// for it and of the material's name.
void check_melting(const Scene& scene, const BodyDescription& body, const std::string& into,
                   const std::string& path, const std::string& into_path, RangeCheck& check);

/// Everything about a body but its name's uniqueness and what depends on other bodies. The body's
/// particles, where it was sampled and has no errors.
std::optional<SampledBody> check_body(const Scene& scene, const Vec3& vat_offset,
                                      const BodyDescription& body, const std::string& path,
                                      Allowance& allowance, RangeCheck& check);

/// That all these are between the walls that the vat has, moved by `offset`.
void check_inside_vat(const Scene& scene, const Vec3& offset, std::span<const Vec3> positions,
                      const std::string& path, RangeCheck& check);

/// Where a body starts and how it moves: ranges, and what its kind allows.
void check_motion(const BodyDescription& body, const std::string& path, RangeCheck& check);

/// What fields make of a body's particles.
void check_start(const BodyDescription& body, const SampledBody& sample, const std::string& path,
                 RangeCheck& check);

/// Ranges of the shape's own values, and for meshes whether they can be filled. True where the
/// shape can be sampled.
bool check_shape(const BodyDescription& body, const std::string& path, RangeCheck& check);

}  // namespace vat
