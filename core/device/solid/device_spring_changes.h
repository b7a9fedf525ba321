#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/device/opencl/program.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/model.h"
#include "core/state/state.h"

namespace vat {

/// Plastic flow and tearing of springs on a device, see spring_changes.cl. The springs of
/// SolidTables have their present rest lengths. The functions throw opencl::DeviceFailure.
class DeviceSpringChanges {
 public:
  /// For a model whose springs change.
  DeviceSpringChanges(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Writes the springs of a state.
  void write(const Model& model, const Configuration& from, const SolidTables& tables);
  /// Reads the springs. The function copy_to() then writes them.
  void read(const SolidTables& tables);
  void copy_to(Configuration& to) const;
  /// Saves the present springs, or returns to the saved ones.
  void save(const SolidTables& tables);
  void restore(const SolidTables& tables);

  /// Returns whether springs are torn, by spring end.
  const opencl::Buffer& are_torn() const { return are_torn_; }

  /// Changes the springs after a step.
  void change(const opencl::Buffer& position, const SolidTables& tables);

 private:
  opencl::Program& program_;
  const std::size_t count_;            ///< spring ends
  const std::size_t free_;             ///< free particles
  const std::vector<SpringEnd> ends_;  ///< at the start of the scene, for particles of SolidRange
  opencl::Buffer starts_;              ///< rest lengths at the start of the scene
  opencl::Buffer changes_;             ///< by material
  opencl::Buffer are_torn_, saved_are_torn_, saved_springs_;
  std::vector<SpringEnd> springs_;  ///< read
  std::vector<std::int32_t> torn_;  ///< read
};

}  // namespace vat
