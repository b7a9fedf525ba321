#pragma once

#include <cstdio>
#include <string>
#include <vector>

#include "tests/stability/adversarial/adversarial.h"

/// The parts of adversarial_cases().
namespace vat::stability {

using Cases = std::vector<AdversarialCase>;

void add_overlap_cases(Cases& cases);      ///< bodies in each other at the start
void add_compression_cases(Cases& cases);  ///< bodies compressed at the start
void add_stiffness_cases(
    Cases& cases);  ///< mass ratios, stiff next to soft springs, steps that are too long
void add_motion_cases(Cases& cases);   ///< projectiles, vats that accelerate and tilt
void add_place_cases(Cases& cases);    ///< far from the origin, few particles, many particles
void add_range_cases(Cases& cases);    ///< materials at the limits of their ranges
void add_refusal_cases(Cases& cases);  ///< invalid scenes
void add_command_cases(Cases& cases);  ///< commands at critical moments

/// Formats a value for the name of a case.
inline std::string label(Real value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

/// Returns the total momentum, divided by the sum of m |v|.
Real relative_momentum(const Simulation& simulation);

}  // namespace vat::stability
