// What the step plan declares against what its stages do: every column that a stage does not
// declare is spoilt before it runs, and the stage must not be seen to notice, nor to touch it.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <memory>

#include "core/limits.h"
#include "core/model/compile.h"
#include "core/step/workspace.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::step_columns_test {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

/// Everything that stages hand to one another.
struct Columns {
  State state;
  Workspace work;
};

bool has(const std::vector<Column>& columns, Column column) {
  return std::ranges::find(columns, column) != columns.end();
}

template <class Vector>
void spoil_vectors(Vector& vectors) {
  for (Vec3& value : vectors) value.setConstant(kNan);
}

void spoil(Column column, Columns& columns) {
  Configuration& now = columns.state.now;
  Forces& forces = columns.state.forces;
  switch (column) {
    case Column::position:
      return spoil_vectors(now.position);
    case Column::velocity:
      return spoil_vectors(now.velocity);
    case Column::rigid_state:
      for (RigidState& rigid : now.rigid) rigid.center_of_mass.setConstant(kNan);
      return;
    case Column::force:
      return spoil_vectors(forces.particle);
    case Column::liquid_cells:
      columns.work.liquid = {};
      return;
    case Column::solid_cells:
      columns.work.solids_in_liquid = {};
      return;
    case Column::pair_clusters:
      columns.work.sources = {};
      columns.work.liquid_clusters = {};
      columns.work.solid_clusters = {};
      return;
    case Column::pair_motion:
      for (std::size_t n = 0; n < columns.work.sources.motion_count(); ++n) {
        columns.work.sources.set_motion(n, {kNan, kNan, kNan, kNan});
      }
      return;
    case Column::liquid_pairs:
      for (PairBlock& block : columns.work.liquid_pairs) block.begin.fill(0);
      return;
    case Column::density:
      std::ranges::fill(columns.work.density, kNan);
      return;
    case Column::cell_pressure:
      std::ranges::fill(columns.work.cell_pressure, kNan);
      return;
    case Column::filled_density:
      std::ranges::fill(columns.work.filled_density, kNan);
      return;
    case Column::pressure:
      std::ranges::fill(columns.work.pressure, kNan);
      return;
    case Column::liquid_solids:
      for (PairBlock& block : columns.work.solids_of_liquid) block.begin.fill(0);
      for (PairBlock& block : columns.work.liquid_of_solids) block.begin.fill(0);
      return;
    case Column::solid_pressure:
      std::ranges::fill(columns.work.solid_pressure, kNan);
      return;
    case Column::transport:
      return spoil_vectors(forces.transport);
    case Column::surface:
      for (SurfaceRecord& record : columns.work.surface) record = {Vec3::Constant(kNan), kNan};
      return;
    case Column::surface_normals:
      return spoil_vectors(columns.work.surface_normals);
    case Column::contact_list:
      columns.work.contacts = {};
      return;
    case Column::yielding:
      return spoil_vectors(columns.work.yieldings);
    case Column::rigid_force:
      spoil_vectors(forces.rigid_force);
      return spoil_vectors(forces.rigid_torque);
    case Column::kept_pressure:
      std::ranges::fill(now.pressure, kNan);
      return;
  }
}

template <class T>
std::vector<char> bytes_of(const std::vector<T>& values) {
  std::vector<char> bytes(values.size() * sizeof(T));
  if (!bytes.empty())
    std::memcpy(bytes.data(), static_cast<const void*>(values.data()), bytes.size());
  return bytes;
}

/// The column's bits.
std::vector<char> content(Column column, const Columns& columns) {
  const Configuration& now = columns.state.now;
  const Forces& forces = columns.state.forces;
  switch (column) {
    case Column::position:
      return bytes_of(now.position);
    case Column::velocity:
      return bytes_of(now.velocity);
    case Column::rigid_state: {
      std::vector<Vec3> centers;
      for (const RigidState& rigid : now.rigid) centers.push_back(rigid.center_of_mass);
      return bytes_of(centers);
    }
    case Column::force:
      return bytes_of(forces.particle);
    case Column::liquid_cells:
      return bytes_of(columns.work.liquid.x);
    case Column::solid_cells:
      return bytes_of(columns.work.solids_in_liquid.x);
    case Column::pair_clusters: {
      std::vector<Vec3> places;
      for (std::size_t n = 0; n < columns.work.sources.count(); ++n) {
        places.push_back(columns.work.sources.place(n));
      }
      return bytes_of(places);
    }
    case Column::pair_motion: {
      std::vector<PairMotion> motions;
      for (std::size_t n = 0; n < columns.work.sources.motion_count(); ++n) {
        motions.push_back(columns.work.sources.motion(n));
      }
      return bytes_of(motions);
    }
    case Column::liquid_pairs: {
      std::vector<Index> ends;
      for (const PairBlock& block : columns.work.liquid_pairs) ends.push_back(block.begin[1]);
      return bytes_of(ends);
    }
    case Column::density:
      return bytes_of(columns.work.density);
    case Column::filled_density:
      return bytes_of(columns.work.filled_density);
    case Column::pressure:
      return bytes_of(columns.work.pressure);
    case Column::liquid_solids: {
      std::vector<Index> ends;
      for (const PairBlock& block : columns.work.solids_of_liquid) ends.push_back(block.begin[1]);
      return bytes_of(ends);
    }
    case Column::solid_pressure:
      return bytes_of(columns.work.solid_pressure);
    case Column::transport:
      return bytes_of(forces.transport);
    case Column::surface:
      return bytes_of(columns.work.surface);
    case Column::surface_normals:
      return bytes_of(columns.work.surface_normals);
    case Column::contact_list: {
      std::vector<Index> listed;
      const ContactList& list = columns.work.contacts;
      for (std::size_t b = 0; list.size() > 0 && b < block_count(now.position.size()); ++b) {
        listed.insert(listed.end(), list.particles(b).begin(), list.particles(b).end());
      }
      return bytes_of(listed);
    }
    case Column::yielding:
      return bytes_of(columns.work.yieldings);
    case Column::cell_pressure:
      return bytes_of(columns.work.cell_pressure);
    case Column::rigid_force:
      return bytes_of(forces.rigid_force);
    case Column::kept_pressure:
      return bytes_of(now.pressure);
  }
  return {};
}

void run(const Stage& stage, const Model& model, Columns& columns) {
  const Controls controls;
  StepContext context{.model = model,
                      .controls = controls,
                      .time = 0,
                      .step = 0,
                      .configuration = columns.state.now,
                      .forces = columns.state.forces,
                      .work = columns.work,
                      .runner = nullptr};
  stage.run(context);
}

/// Runs the plan, and each of its stages a second time on spoilt columns.
void expect_declared(const Scene& scene) {
  const std::vector<BodyId> ids(scene.bodies.size(), 1);
  const auto model =
      compile(scene, ids, std::vector<std::shared_ptr<const SampledBody>>(ids.size()));
  Columns columns{initial_state(*model), {}};
  for (const Stage& stage : model->plan.stages) {
    Columns spoilt = columns;
    for (std::size_t c = 0; c < kColumnCount; ++c) {
      const auto column = static_cast<Column>(c);
      if (!has(stage.reads, column) && !has(stage.writes, column)) spoil(column, spoilt);
    }
    const Columns before = spoilt;
    run(stage, *model, columns);
    run(stage, *model, spoilt);
    for (std::size_t c = 0; c < kColumnCount; ++c) {
      const auto column = static_cast<Column>(c);
      const Columns& expected = has(stage.writes, column) ? columns : before;
      EXPECT_EQ(content(column, spoilt), content(column, expected))
          << stage.name << ", column " << c;
    }
  }
}

/// Bodies of each kind that touch one another and the walls, so that every stage has work.
Scene crowded_scene(Real viscosity) {
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {test::make_liquid("water", 1000, {100, viscosity, 0.1}),
                     test::make_liquid("oil", 900, {100, viscosity, 0.1}),
                     test::make_material("solid")};
  scene.vat = Vat{Vec3::Constant(-0.15), Vec3::Constant(0.4), true, {}};
  const std::vector<Vec3> points = test::make_lattice(3, 3, 3, 0.05);
  const auto add = [&](const char* name, BodyKind kind, const char* material, Real x) {
    BodyDescription body =
        test::make_body(name, kind, material, test::make_particles(points, 0.3), 0.05);
    body.position = {x, 0.01 * x, -0.05};
    body.velocity = {-1, x, 1};
    scene.bodies.push_back(body);
  };
  add("pool", BodyKind::liquid, "water", -0.05);
  add("film", BodyKind::liquid, "oil", 0.06);
  add("cloth", BodyKind::deformable, "solid", 0.17);
  add("ball", BodyKind::rigid, "solid", 0.28);
  scene.bodies[2].springs = test::join_near(points, 0.08, {100, 1});
  for (SpringDescription& spring : scene.bodies[2].springs) spring.rest_length = 0.04;
  return scene;
}

TEST(StepColumns, AreReadAndWrittenAsDeclared) {
  expect_declared(crowded_scene(1));
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWithoutViscosity) {
  expect_declared(crowded_scene(0));
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredBesideNoSlipWalls) {
  Scene scene = crowded_scene(1);
  scene.vat->walls[4] = {true, {0.5, 0, 0}};
  expect_declared(scene);
  scene.forces.pressure = false;
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWithOtherLawsOfInterfaces) {
  Scene scene = crowded_scene(1);
  scene.default_interface = {.stiffness = 100, .restitution = 0.5};
  expect_declared(scene);
  scene.interfaces = {
      {{"solid", "vat"}, {.friction = 0.1, .law = InterfaceLaw::projection}, {}},
      {{"water", "solid"}, {.stiffness = 100, .law = InterfaceLaw::lennard_jones}, {}}};
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWithoutPressure) {
  Scene scene = crowded_scene(1);
  scene.forces.pressure = false;
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWhereSolidsTakePart) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::tait;
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWhereWallsDragALiquidThatTheyTakePartIn) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::tait;
  scene.vat->walls[4] = {true, {0.5, 0, 0}};
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWithoutAFreeSurface) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::tait;
  scene.vat->max = {0.35, 0.15, 0.15};
  ASSERT_TRUE(test::ForceProbe(scene).model().is_filled);
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWhereCellsKeepTheirVolume) {
  Scene scene = crowded_scene(1);
  scene.materials[2].bulk_modulus = 1e4;
  scene.bodies[2].springs.clear();
  scene.bodies[2].shape = BoxShape{{0, 0, 0}, {0.15, 0.15, 0.15}};
  scene.bodies[2].spacing = 0.05;
  scene.bodies[2].displacement_field = VectorField{Vec3::Zero(), 0.1 * Mat3::Identity(), {}};
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWithSurfaceTension) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::tait;
  for (Material& material : scene.materials) {
    if (material.liquid) material.liquid->surface_tension = 10;
  }
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWhereLiquidsAttractThemselves) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::tait;
  scene.surface_model = SurfaceModel::cohesion;
  for (Material& material : scene.materials) {
    if (material.liquid) material.liquid->surface_tension = 10;
  }
  expect_declared(scene);
}

TEST(StepColumns, AreReadAndWrittenAsDeclaredWherePressureIsKept) {
  Scene scene = crowded_scene(1);
  scene.pressure_solver = PressureSolver::incompressible;
  expect_declared(scene);
}

TEST(StepColumns, OfACollapsedLiquidAreCutOffAndFailTheStep) {
  const auto count = static_cast<int>(1.5 * std::sqrt(max_pairs(1)));
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(1e-6 * i, 0, 0);
  Scene scene = test::make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.materials = {test::make_liquid("water", 1000, {100, 0, 0.1})};
  scene.bodies = {
      test::make_body("drop", BodyKind::liquid, "water", test::make_particles(points, 0.1), 0.05)};
  const auto model = compile(scene, {1}, {nullptr});
  Columns columns{initial_state(*model), {}};
  for (const Stage& stage : model->plan.stages) run(stage, *model, columns);
  EXPECT_TRUE(columns.work.too_many_pairs);
  EXPECT_TRUE(columns.state.forces.particle[0].hasNaN());
  std::size_t pairs = 0;
  for (const PairBlock& block : columns.work.liquid_pairs) pairs += block.slots.size();
  EXPECT_LT(static_cast<Real>(pairs), 1.3 * static_cast<Real>(max_pairs(points.size())));
}

}  // namespace
}  // namespace vat::step_columns_test
