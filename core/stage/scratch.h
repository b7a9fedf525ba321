#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/support/instruction_set.h"

namespace vat {

/// The methods that keep buffers from one force evaluation to the next.
enum class Method : std::uint8_t { liquid, surface, contact, solid, incompressible };
inline constexpr std::size_t kMethodCount = 5;

/// The buffers of all methods. A method defines their type, with `kMethod`, and reaches only its
/// own and those of methods below it. The buffers are kept so that a steady step allocates nothing.
/// Their content is valid during one evaluation, except lists that detect when they are out of
/// date.
class Scratch {
 public:
  InstructionSet instructions = InstructionSet::baseline;  ///< of the vectorised loops
  bool keep_dampers = false;  ///< stages keep the dampers of their forces, for an implicit solve

  template <class Buffers>
  Buffers& of() {
    return *static_cast<Buffers*>(buffers_[static_cast<std::size_t>(Buffers::kMethod)]);
  }
  template <class Buffers>
  const Buffers& of() const {
    return *static_cast<const Buffers*>(buffers_[static_cast<std::size_t>(Buffers::kMethod)]);
  }

 protected:
  Scratch() = default;
  Scratch(const Scratch&) = default;
  Scratch& operator=(const Scratch&) = delete;
  ~Scratch() = default;

  template <class Buffers>
  void set(Buffers& buffers) {
    buffers_[static_cast<std::size_t>(Buffers::kMethod)] = &buffers;
  }

 private:
  std::array<void*, kMethodCount> buffers_{};
};

}  // namespace vat
