#include "tests/protocol/scene/scene_json_cases.h"

#include "core/saved/saved_fields.h"

namespace vat::scene_cases {

const char* const kFullDocument = R"json({
  "format": "vat.scene/1",
  "name": "everything",
  "title": "Every member",
  "description": "One body of each kind and shape",
  "gravity": [0.125, -0.25, -1.625],
  "dimensions": 3,
  "pressure_solver": "gas",
  "printed_pressure_force": true,
  "kernel": "cubic_spline",
  "pair_precision": "double",
  "surface_tension_model": "cohesion",
  "periodic": {"axes": ["x"], "min": [-2, -1, -2.5], "max": [3, 5, 6]},
  "central_field": {"center": [0.5, -0.125, 0.75], "angular_frequency": 1.25},
  "incompressible": {"density_tolerance": 0.00025, "divergence_tolerance": 2e-05,
                     "most_iterations": 40},
  "settling": {"drag": 47.5, "until": 0.1875},
  "sleeping": {"speed": 0.03125, "after": 0.75},
  "emitters": [
    {"name": "hose", "body": "pool", "position": [1.5, -0.5, 1.5], "direction": [0, 1, -1],
     "size": [0.25, 0.125], "speed": 0.5, "from": 0.5, "until": 2.5, "most_particles": 4000,
     "open": false},
    {"name": "tap", "body": "pool", "position": [2.5, 0.5, 1.75], "radius": 0.125, "speed": 0.75,
     "most_particles": 5000}
  ],
  "drains": [{"name": "hole", "min": [-1, -1, -0.5], "max": [-0.5, -0.5, -0.25]}],
  "forces": {"gravity": false, "pressure": false, "viscosity": false, "springs": false,
             "contacts": false, "walls": false},
  "materials": [
    {"name": "water", "density": 998.5,
     "liquid": {"stiffness": 90, "viscosity": 0.75, "support_radius": 0.125,
                "artificial_viscosity": 0.25},
     "appearance": {"colour": "#1a2B3c", "roughness": 0.125, "metalness": 0.75, "opacity": 0.625,
                    "absorption_length": 0.375, "finish": "steel"}},
    {"name": "rubber", "density": 500.25,
     "springs": {"structural": {"stiffness": 1000.5, "damping": 1.5},
                 "shear": {"stiffness": 500.5, "damping": 0.5},
                 "bend": {"stiffness": 250.5, "damping": 0.25}},
     "self_contact": {"stiffness": 300.5, "damping": 2.5}, "implicit_springs": true,
     "plasticity": {"yield_strain": 0.0625, "hardening": 0.25, "relaxation_time": 1.5,
                    "max_strain": 0.375},
     "tearing_strain": 0.75},
    {"name": "wood", "density": 600.125, "elongation_limit": 0.125, "bulk_modulus": 2500.5}
  ],
  "default_interface": {"stiffness": 1500.5, "damping": 3.5, "friction": 0.375},
  "interfaces": [
    {"materials": ["water", "vat"], "stiffness": 2000.5, "damping": 5.5, "friction": 1.25,
     "threshold": 0.0625, "contact_angle": 112.5},
    {"materials": ["rubber", "wood"], "stiffness": 800.5, "damping": 4.5, "threshold": 0.03125},
    {"materials": ["rubber", "vat"], "law": "penalty", "stiffness": 700.5, "restitution": 0.75},
    {"materials": ["water", "rubber"], "law": "lennard_jones", "stiffness": 90.5, "reach": 1.5,
     "threshold": 0.09375},
    {"materials": ["wood", "vat"], "law": "projection", "friction": 0.25, "restitution": 0.5,
     "threshold": 0.046875}
  ],
  "vat": {"min": [-2, -1.5, -0.5], "max": [3, 1.75, 2.5], "lid": true,
          "motion": {"type": "slide", "axis": [0, 2, 0], "stroke": 0.2, "period": 2.5},
          "walls": {"y_min": {"no_slip": true, "velocity": [0.5, 0, -0.25]},
                    "z_max": {"no_slip": true}}},
  "numerics": {"integrator": "velocity_verlet", "step": 0.0005, "tick": 0.01,
               "control": "adaptive"},
  "bodies": [
    {"name": "pool", "kind": "liquid", "material": "water", "spacing": 0.0625,
     "shape": {"type": "box", "center": [0.1, 0.2, 0.3], "size": [0.5, 0.25, 0.125]},
     "radius": 0.03, "position": [1, -0.5, 0.25], "orientation": [0.5, 0.5, 0.5, 0.5],
     "velocity": [0.1, 0.2, 0.3], "jitter": 0.125, "seed": 4294967295,
     "velocity_field": {"center": [0.1, 0.2, 0.3],
                        "gradient": [[1, 2, 3], [4, 5, 6], [7, 8, 9.5]],
                        "waves": [{"amplitude": [0.1, 0.2, 0.3], "wave_vector": [1, 2, 3],
                                   "phase": 0.5},
                                  {"amplitude": [0, 0, 1], "wave_vector": [4, 0, 0]}]},
     "displacement_field": {"waves": [{"amplitude": [0.01, 0.02, 0.03],
                                       "wave_vector": [3, 2, 1]}]}},
    {"name": "ball", "kind": "rigid", "material": "wood", "spacing": 0.05,
     "shape": {"type": "sphere", "center": [0.01, 0.02, 0.03], "radius": 0.125},
     "mass": 2.5, "position": [-1, 0.5, 1.5], "angular_velocity": [1.5, -2.5, 3.5],
     "release": 0.75},
    {"name": "rod", "kind": "deformable", "material": "rubber", "spacing": 0.04,
     "shape": {"type": "cylinder", "center": [0, 0, 0.1], "axis": [1, 2, 2],
               "radius": 0.1, "height": 0.3},
     "position": [-1, -0.75, 1.5], "melting": {"into": "water", "at": 1.25}},
    {"name": "wedge", "kind": "rigid", "material": "wood", "spacing": 0.05,
     "shape": {"type": "mesh", "file": "meshes/wedge.obj", "scale": 0.5}, "position": [2, 0, 1],
     "fixed": true},
    {"name": "tetra", "kind": "rigid", "material": "wood", "spacing": 0.05,
     "shape": {"type": "mesh", "source": "by hand",
               "vertices": [[0, 0, 0], [0.5, 0, 0], [0, 0.5, 0], [0, 0, 0.5]],
               "triangles": [[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]},
     "position": [2, 0.75, 1], "angular_velocity": [2, 0, 1],
     "axle": {"direction": [4, 0, 2], "damping": 0.375}, "sub_steps": 24},
    {"name": "pair", "kind": "deformable", "material": "rubber", "spacing": 0.05,
     "shape": {"type": "particles",
               "positions": [[0, 0, 0], [0.1, 0, 0], [0.2, 0, 0]],
               "velocities": [[0, 0, 0], [0, 1, 0], [0, 0, 1]],
               "masses": [0.1, 0.2, 0.3],
               "radii": [0.01, 0.02, 0.03],
               "fixed": [0]},
     "springs": [{"particles": [0, 1], "stiffness": 100.5, "damping": 0.125, "rest_length": 0.2},
                 {"particles": [2, 1], "stiffness": 50.5}],
     "position": [0, 1, 2]},
    {"name": "piston", "kind": "rigid", "material": "wood", "spacing": 0.05,
     "shape": {"type": "sphere", "radius": 0.125}, "position": [-1, 1, 0.5],
     "motion": {"type": "slide", "axis": [1, 0, 2], "stroke": -0.25, "period": 4.5}}
  ]
})json";

namespace {

std::vector<Material> full_materials() {
  Material water{"water", 998.5, LiquidConstants{90, 0.75, 0.125, 0.25}, {}, {}};
  water.appearance = {Colour{0x1a, 0x2b, 0x3c}, 0.125, 0.75, 0.625, 0.375, Finish::steel};
  return {water,
          {"rubber",
           500.25,
           {},
           LatticeSprings{SpringConstants{1000.5, 1.5}, SpringConstants{500.5, 0.5},
                          SpringConstants{250.5, 0.25}},
           SpringConstants{300.5, 2.5},
           true,
           Plasticity{0.0625, 0.25, 1.5, 0.375},
           0.75},
          {"wood", 600.125, {}, {}, {}, false, {}, {}, 0.125, 2500.5}};
}

BodyDescription body(const char* name, BodyKind kind, const char* material, Shape shape,
                     Real spacing, const Vec3& position) {
  BodyDescription result{name, kind, material, std::move(shape), spacing};
  result.position = position;
  return result;
}

const std::vector<std::array<Index, 3>> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};

MeshShape tetrahedron(const char* source) {
  return {source, {{0, 0, 0}, {0.5, 0, 0}, {0, 0.5, 0}, {0, 0, 0.5}}, kTetrahedron};
}

ParticleShape full_particles() {
  return {{{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}},
          {{0, 0, 0}, {0, 1, 0}, {0, 0, 1}},
          {0.1, 0.2, 0.3},
          {0.01, 0.02, 0.03},
          {0}};
}

std::vector<BodyDescription> full_bodies() {
  std::vector<BodyDescription> bodies{
      body("pool", BodyKind::liquid, "water", BoxShape{{0.1, 0.2, 0.3}, {0.5, 0.25, 0.125}}, 0.0625,
           {1, -0.5, 0.25}),
      body("ball", BodyKind::rigid, "wood", SphereShape{{0.01, 0.02, 0.03}, 0.125}, 0.05,
           {-1, 0.5, 1.5}),
      body("rod", BodyKind::deformable, "rubber", CylinderShape{{0, 0, 0.1}, {1, 2, 2}, 0.1, 0.3},
           0.04, {-1, -0.75, 1.5}),
      body("wedge", BodyKind::rigid, "wood", tetrahedron("meshes/wedge.obj"), 0.05, {2, 0, 1}),
      body("tetra", BodyKind::rigid, "wood", tetrahedron("by hand"), 0.05, {2, 0.75, 1}),
      body("pair", BodyKind::deformable, "rubber", full_particles(), 0.05, {0, 1, 2}),
      body("piston", BodyKind::rigid, "wood", SphereShape{Vec3::Zero(), 0.125}, 0.05,
           {-1, 1, 0.5})};
  bodies[0].radius = 0.03;
  bodies[0].orientation = Quat(0.5, 0.5, 0.5, 0.5);
  bodies[0].velocity = {0.1, 0.2, 0.3};
  bodies[0].velocity_field =
      VectorField{{0.1, 0.2, 0.3},
                  (Mat3() << 1, 2, 3, 4, 5, 6, 7, 8, 9.5).finished(),
                  {{{0.1, 0.2, 0.3}, {1, 2, 3}, 0.5}, {{0, 0, 1}, {4, 0, 0}, 0}}};
  bodies[0].displacement_field =
      VectorField{Vec3::Zero(), Mat3::Zero(), {{{0.01, 0.02, 0.03}, {3, 2, 1}, 0}}};
  bodies[0].jitter = 0.125;
  bodies[0].seed = 4294967295;
  bodies[1].mass = 2.5;
  bodies[1].angular_velocity = {1.5, -2.5, 3.5};
  bodies[1].release = 0.75;
  bodies[2].melting = Melting{"water", 1.25};
  bodies[3].fixed = true;
  bodies[4].angular_velocity = {2, 0, 1};
  bodies[4].axle = Axle{{4, 0, 2}, 0.375};
  bodies[4].sub_steps = 24;
  bodies[6].motion = SlideMotion{{1, 0, 2}, -0.25, 4.5};
  bodies[5].springs = {{0, 1, {100.5, 0.125}, 0.2}, {2, 1, {50.5, 0}, {}}};
  return bodies;
}

}  // namespace

Scene full_scene() {
  Scene scene;
  scene.pressure_solver = PressureSolver::gas;
  scene.printed_pressure_force = true;
  scene.kernel = KernelId::cubic_spline;
  scene.pair_precision = PairPrecision::double_precision;
  scene.surface_model = SurfaceModel::cohesion;
  scene.name = "everything";
  scene.title = "Every member";
  scene.description = "One body of each kind and shape";
  scene.gravity = {0.125, -0.25, -1.625};
  scene.materials = full_materials();
  scene.default_interface = {1500.5, 3.5, 0.375};
  scene.interfaces = {{{"water", "vat"}, {2000.5, 5.5, 1.25}, 0.0625, 112.5},
                      {{"rubber", "wood"}, {800.5, 4.5}, 0.03125},
                      {{"rubber", "vat"}, {.stiffness = 700.5, .restitution = 0.75}, {}},
                      {{"water", "rubber"},
                       {.stiffness = 90.5, .law = InterfaceLaw::lennard_jones, .reach = 1.5},
                       0.09375},
                      {{"wood", "vat"},
                       {.friction = 0.25, .law = InterfaceLaw::projection, .restitution = 0.5},
                       0.046875}};
  scene.vat = Vat{{-2, -1.5, -0.5}, {3, 1.75, 2.5}, true, SlideMotion{{0, 2, 0}, 0.2, 2.5}, {}};
  scene.vat->walls[2] = {true, {0.5, 0, -0.25}};
  scene.vat->walls[5].no_slip = true;
  scene.periodic = Periodicity{{-2, -1, -2.5}, {3, 5, 6}, {true, false, false}};
  scene.central_field = CentralField{{0.5, -0.125, 0.75}, 1.25};
  scene.incompressible = {0.00025, 2e-5, 40};
  scene.settling = Settling{47.5, 0.1875};
  scene.sleeping = Sleeping{0.03125, 0.75};
  scene.emitters = {{.name = "hose",
                     .body = "pool",
                     .position = {1.5, -0.5, 1.5},
                     .direction = {0, 1, -1},
                     .size = {{0.25, 0.125}},
                     .speed = 0.5,
                     .from = 0.5,
                     .until = 2.5,
                     .most_particles = 4000,
                     .open = false},
                    {.name = "tap",
                     .body = "pool",
                     .position = {2.5, 0.5, 1.75},
                     .radius = 0.125,
                     .speed = 0.75,
                     .most_particles = 5000}};
  scene.drains = {{"hole", {-1, -1, -0.5}, {-0.5, -0.5, -0.25}}};
  scene.forces = {false, false, false, false, false, false};
  scene.numerics = {IntegratorId::velocity_verlet, 0.0005, 0.01, StepControl::adaptive};
  scene.bodies = full_bodies();
  return scene;
}

Result<std::string> full_meshes(const std::string& name) {
  if (name != "meshes/wedge.obj") return no_meshes(name);
  return std::string(
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
      "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n");
}

Result<std::string> no_meshes(const std::string& name) {
  return Error{"no_such_file", "", name + ": is not there"};
}

std::vector<std::uint8_t> bits_of(const Scene& scene) {
  std::vector<std::uint8_t> bytes;
  SavingArchive archive(bytes);
  archive(scene);
  for (const Material& material : scene.materials) archive(material.appearance);
  for (const BodyDescription& body : scene.bodies) {
    archive(body.motion, body.axle, body.sub_steps);
  }
  return bytes;
}

std::string lines(const Errors& errors) {
  std::string result;
  for (const Error& error : errors) result += error.code + ' ' + error.path + '\n';
  return result;
}

}  // namespace vat::scene_cases
