#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/support/instruction_set.h"

namespace vat {

/// The methods whose buffers persist between force evaluations.
enum class Method : std::uint8_t { liquid, surface, contact, solid, incompressible };
inline constexpr std::size_t kMethodCount = 5;

/// The buffers of all methods. Each method defines the type of its buffers, with a constant
/// `kMethod`. A method accesses only its own buffers and the buffers of methods on which it
/// depends. The buffers persist between evaluations to avoid allocations. The content of the
/// buffers is valid during one evaluation, except for lists with a check for validity.
class Scratch {
 public:
  InstructionSet instructions = InstructionSet::baseline;  ///< used by the vectorised loops
  bool keep_dampers = false;  ///< stages store the dampers of their forces for an implicit solve

  template <class Buffers>
  Buffers& of() {
    return *static_cast<Buffers*>(buffers_[static_cast<std::size_t>(Buffers::kMethod)]);
  }
  template <class Buffers>
  const Buffers& of() const {
    return *static_cast<const Buffers*>(buffers_[static_cast<std::size_t>(Buffers::kMethod)]);
  }
  Scratch& operator=(const Scratch&) = delete;

 protected:
  Scratch() = default;
  Scratch(const Scratch&) = default;
  ~Scratch() = default;

  template <class Buffers>
  void set(Buffers& buffers) {
    buffers_[static_cast<std::size_t>(Buffers::kMethod)] = &buffers;
  }

 private:
  std::array<void*, kMethodCount> buffers_{};
};

}  // namespace vat
