#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tests/stability/adversarial/adversarial.h"

/// The parts of adversarial_cases().
namespace vat::stability {

using Cases = std::vector<AdversarialCase>;

void add_overlap_cases(Cases& cases);      ///< bodies in each other at the start
void add_compression_cases(Cases& cases);  ///< bodies crushed at the start
void add_stiffness_cases(Cases& cases);    ///< mass ratios, stiff beside soft, steps too long
void add_motion_cases(Cases& cases);       ///< projectiles, vats that accelerate and tilt
void add_place_cases(Cases& cases);        ///< far from the origin, few particles, many
void add_range_cases(Cases& cases);        ///< materials at the limits of their ranges
void add_refusal_cases(Cases& cases);      ///< what is no scene
void add_command_cases(Cases& cases);      ///< commands in the worst moment

/// A value as it stands in a case's name.
inline std::string label(Real value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// The momentum of everything over the sum of m |v|.
Real relative_momentum(const Simulation& simulation);

}  // namespace vat::stability
