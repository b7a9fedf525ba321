#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/device/contact/solid_geometry.h"
#include "core/device/opencl/program.h"
#include "core/device/solid/solid_tables.h"
#include "core/model/model.h"
#include "core/stage/advance_report.h"

namespace vat {

/// The drift and the dashpots of bodies with implicit springs on a device, see implicit_springs.cl.
/// Each group of work-items moves one body, and decides when its solves end. The functions throw
/// opencl::DeviceFailure.
class DeviceImplicitSprings {
 public:
  /// For a model with implicit springs.
  DeviceImplicitSprings(opencl::Program& program, const Model& model);

  /// Returns the bytes of the buffers.
  static std::size_t bytes_for(const Model& model);

  /// Moves the bodies from the positions `start` over a drift of `dt` [s].
  void drift(Real dt, const SolidTables& tables, const opencl::Buffer& start,
             const opencl::Buffer& position, const opencl::Buffer& velocity);
  /// Applies the dashpots over `dt` [s].
  void damp(Real dt, const SolidTables& tables, const opencl::Buffer& position,
            const opencl::Buffer& velocity);

  void clear_counts();
  /// Adds the work since clear_counts() to a report.
  void count(AdvanceReport& report);

 private:
  void move(Real dt, bool is_damping, const SolidTables& tables, const opencl::Buffer& start,
            const opencl::Buffer& position, const opencl::Buffer& velocity);

  /// The struct Implicit of spring_system.cl.
  struct Constants {
    std::int32_t begin;
    std::int32_t count;
    std::int32_t springs_begin;
    std::int32_t first;
    std::int32_t dimensions;
    std::int32_t padding;
    double dt;
  };
  /// The struct ImplicitBody of spring_system.cl.
  struct Body {
    std::int64_t factor_begin;
    double free_mass;
    std::int32_t begin;
    std::int32_t end;
    std::int32_t width;
    std::int32_t factor_cost;
    std::int32_t can_turn;
    std::int32_t pivot;
    std::int32_t is_damped;
    std::int32_t padding;
  };
  /// The struct ImplicitCounts of spring_system.cl.
  struct Counts {
    std::uint64_t passes;
    std::uint64_t unsolved;
  };
  /// The bodies, and the size of their factors in numbers.
  struct Bodies {
    std::vector<Body> bodies;
    std::size_t factor_size = 0;
  };

  static Bodies bodies_of(const Model& model);

  opencl::Program& program_;
  const Bodies bodies_;
  const Constants constants_;
  bool are_damped_ = false;  ///< any body has dashpots
  opencl::Buffer table_, stiffness_, places_, slopes_, factor_, columns_, counts_;
};

}  // namespace vat
