#pragma once

namespace vat::test {

/// The scene file "pool": some water (body 1), a ball (2) and a cube (3). A session of it is cheap,
/// so the clients dominate the load. The space above the middle is free for more bodies.
inline constexpr const char* kPoolScene = R"({
  "format": "vat.scene/1", "name": "pool", "title": "Pool",
  "materials": [
    {"name": "water", "density": 1000,
     "liquid": {"stiffness": 50, "viscosity": 1, "support_radius": 0.2}},
    {"name": "wood", "density": 600}],
  "default_interface": {"stiffness": 1000, "damping": 1},
  "vat": {"min": [0, 0, 0], "max": [1, 1, 1], "lid": true},
  "numerics": {"integrator": "velocity_verlet", "step": 0.002, "tick": 0.02},
  "bodies": [
    {"name": "water", "kind": "liquid", "material": "water", "spacing": 0.1,
     "shape": {"type": "box", "center": [0.5, 0.5, 0.2], "size": [0.3, 0.3, 0.3]}},
    {"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.1,
     "shape": {"type": "sphere", "radius": 0.11}, "position": [0.7, 0.7, 0.7]},
    {"name": "cube", "kind": "rigid", "material": "wood", "spacing": 0.1,
     "shape": {"type": "box", "size": [0.2, 0.2, 0.2]}, "position": [0.3, 0.3, 0.7]}]})";

}  // namespace vat::test
