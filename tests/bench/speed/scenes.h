#pragma once

#include <cstdint>

#include "core/scene/scene.h"

/// Scenes of the speed benchmark, by size. They are the same on all machines.
namespace vat::bench {

/// A column of water, 0.4 x 0.4 m and 0.8 m high, is released at one end of a closed vat of 1.6 x
/// 0.4 x 1 m. It is the catalogue's dam break with 2 * `layers`^3 particles. Only the lattice and
/// the step depend on `layers`, so all sizes flow alike.
Scene dam_break(int layers, PressureSolver solver);

/// The dam break of SPlisHSPlasH's measurements: `edge`^3 particles in a cubic metre at the end of
/// a closed box of 4 x 1.5 m, 3 m high. tests/bench/README.md compares its settings.
Scene peer_dam_break(int edge, PressureSolver solver);

/// About 10 000 particles of water that fill a vat of 1 x 1 m to 0.64 m and come to rest.
Scene pool(PressureSolver solver);

/// Rigid blocks and balls that fall into a heap, with penalty contacts, in which they creep, or
/// projection contacts, in which they come to rest. `spacing` is that of particles [m].
Scene rigid_pile(std::uint32_t bodies, InterfaceLaw law, Real spacing = 0.04);

/// Blocks of jelly that fall on one another. `spacing` is that of particles [m].
Scene deformable_pile(std::uint32_t bodies, Real spacing = 0.04);

}  // namespace vat::bench
