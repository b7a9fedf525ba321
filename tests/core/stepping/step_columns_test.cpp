// Compares the columns that each stage declares with those that it uses. Every undeclared column is
// filled with NaN before the stage runs. The stage must give the same result and must not write the
// column.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "core/limits.h"
#include "tests/support/force_probe.h"
#include "tests/support/scenes.h"

namespace vat::test::step_columns_test {
namespace {

constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

/// All data that stages pass to one another.
struct Columns {
  State state;
  Workspace work;
};

bool has(const std::vector<Column>& columns, Column column) {
  return std::ranges::find(columns, column) != columns.end();
}

/// An action on the memory of a column: overwrite it or copy it.
class Visit {
 public:
  explicit Visit(bool spoils) : spoils_(spoils) {}

  /// Fills numbers with NaN.
  template <class T>
  void numbers(std::vector<T>& values) {
    static_assert(sizeof(T) % sizeof(Real) == 0);
    auto* const reals = reinterpret_cast<Real*>(values.data());
    const std::size_t count = values.size() * sizeof(T) / sizeof(Real);
    if (spoils_) std::fill_n(reals, count, kNan);
    copy(values);
  }
  /// Resets `value` to its initial content. `copy` returns its content as a vector.
  template <class T, class Copy>
  void structure(T& value, Copy&& copy_of) {
    if (spoils_) value = {};
    copy(copy_of());
  }
  void pair_blocks(std::vector<PairBlock>& blocks) {
    std::vector<Index> ends;
    for (PairBlock& block : blocks) {
      if (spoils_) block.begin.fill(0);
      ends.push_back(block.begin[1]);
    }
    copy(ends);
  }
  template <class T>
  void copy(const std::vector<T>& values) {
    const auto* const first = reinterpret_cast<const char*>(values.data());
    bytes.insert(bytes.end(), first, first + values.size() * sizeof(T));
  }
  bool spoils() const { return spoils_; }

  std::vector<char> bytes;

 private:
  bool spoils_;
};

void visit_sources(PairSources& sources, bool places, Visit& visit) {
  std::vector<Vec3> seen;
  std::vector<PairMotion> motions;
  for (std::size_t n = 0; places && n < sources.count(); ++n) seen.push_back(sources.place(n));
  for (std::size_t n = 0; !places && n < sources.motion_count(); ++n) {
    if (visit.spoils()) sources.set_motion(n, {kNan, kNan, kNan, kNan});
    motions.push_back(sources.motion(n));
  }
  visit.copy(seen);
  visit.copy(motions);
}

std::vector<Index> listed_particles(const ContactList& list, std::size_t particles) {
  std::vector<Index> listed;
  for (std::size_t b = 0; list.size() > 0 && b < block_count(particles); ++b) {
    listed.insert(listed.end(), list.particles(b).begin(), list.particles(b).end());
  }
  return listed;
}

void visit(Column column, Columns& columns, Visit& v) {
  Configuration& now = columns.state.now;
  Forces& forces = columns.state.forces;
  Workspace& work = columns.work;
  switch (column) {
    case Column::position:
      return v.numbers(now.position);
    case Column::velocity:
      return v.numbers(now.velocity);
    case Column::rigid_state: {
      std::vector<Vec3> centers;
      for (RigidState& rigid : now.rigid) {
        if (v.spoils()) rigid.center_of_mass.setConstant(kNan);
        centers.push_back(rigid.center_of_mass);
      }
      return v.copy(centers);
    }
    case Column::force:
      return v.numbers(forces.particle);
    case Column::liquid_cells:
      return v.structure(work.of<LiquidScratch>().liquid,
                         [&] { return work.of<LiquidScratch>().liquid.x; });
    case Column::solid_cells:
      return v.structure(work.of<LiquidScratch>().solids_in_liquid,
                         [&] { return work.of<LiquidScratch>().solids_in_liquid.x; });
    case Column::pair_clusters:
      if (v.spoils()) {
        work.of<LiquidScratch>().sources = {};
        work.of<LiquidScratch>().liquid_clusters = {};
        work.of<LiquidScratch>().solid_clusters = {};
      }
      return visit_sources(work.of<LiquidScratch>().sources, true, v);
    case Column::pair_motion:
      return visit_sources(work.of<LiquidScratch>().sources, false, v);
    case Column::liquid_pairs:
      return v.pair_blocks(work.of<LiquidScratch>().liquid_pairs);
    case Column::density:
      return v.numbers(work.of<LiquidScratch>().density);
    case Column::cell_pressure:
      return v.numbers(work.of<SolidScratch>().cell_pressure);
    case Column::filled_density:
      return v.numbers(work.of<LiquidScratch>().filled_density);
    case Column::pressure:
      return v.numbers(work.of<LiquidScratch>().pressure);
    case Column::liquid_solids:
      return v.pair_blocks(work.of<LiquidScratch>().solids_of_liquid);
    case Column::solid_pressure:
      return v.numbers(work.of<LiquidScratch>().solid_pressure);
    case Column::transport:
      return v.numbers(forces.transport);
    case Column::surface:
      return v.numbers(work.of<SurfaceScratch>().surface);
    case Column::surface_normals:
      return v.numbers(work.of<SurfaceScratch>().surface_normals);
    case Column::contact_list:
      return v.structure(work.of<ContactForceScratch>().contacts, [&] {
        return listed_particles(work.of<ContactForceScratch>().contacts, now.position.size());
      });
    case Column::mobility:
      return v.numbers(work.of<ContactForceScratch>().mobilities);
    case Column::rigid_force:
      v.numbers(forces.rigid_force);
      return v.numbers(forces.rigid_torque);
    case Column::kept_pressure:
      return v.numbers(now.pressure);
  }
}

void spoil(Column column, Columns& columns) {
  Visit spoiling(true);
  visit(column, columns, spoiling);
}

/// Returns the bits of the column.
std::vector<char> content(Column column, Columns& columns) {
  Visit copying(false);
  visit(column, columns, copying);
  return std::move(copying.bytes);
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

/// Runs the plan, and each of its stages a second time with overwritten columns.
void expect_declared(const Scene& scene) {
  const auto model = compile_scene(scene);
  Columns columns{initial_state(*model), {}};
  for (const Stage& stage : model->plan.stages) {
    Columns spoilt = columns;
    for (std::size_t c = 0; c < kColumnCount; ++c) {
      const auto column = static_cast<Column>(c);
      if (!has(stage.reads, column) && !has(stage.writes, column)) spoil(column, spoilt);
    }
    Columns before = spoilt;
    run(stage, *model, columns);
    run(stage, *model, spoilt);
    for (std::size_t c = 0; c < kColumnCount; ++c) {
      const auto column = static_cast<Column>(c);
      Columns& expected = has(stage.writes, column) ? columns : before;
      EXPECT_EQ(content(column, spoilt), content(column, expected))
          << stage.name << ", column " << c;
    }
  }
}

/// Bodies of each kind that touch one another and the walls, so every stage has work.
Scene crowded_scene() {
  Scene scene = make_scene(IntegratorId::velocity_verlet, 1e-3);
  scene.gravity = {0, 0, -9.81};
  scene.materials = {make_liquid("water", 1000, {100, 1, 0.1}),
                     make_liquid("oil", 900, {100, 1, 0.1}), make_material("solid")};
  scene.vat = Vat{Vec3::Constant(-0.15), Vec3::Constant(0.4), true, {}};
  const std::vector<Vec3> points = make_lattice(3, 3, 3, 0.05);
  const auto add = [&](const char* name, BodyKind kind, const char* material, Real x) {
    BodyDescription body = make_body(name, kind, material, make_particles(points, 0.3), 0.05);
    body.position = {x, 0.01 * x, -0.05};
    body.velocity = {-1, x, 1};
    scene.bodies.push_back(body);
  };
  add("pool", BodyKind::liquid, "water", -0.05);
  add("film", BodyKind::liquid, "oil", 0.06);
  add("cloth", BodyKind::deformable, "solid", 0.17);
  add("ball", BodyKind::rigid, "solid", 0.28);
  scene.bodies[2].springs = join_near(points, 0.08, {100, 1});
  for (SpringDescription& spring : scene.bodies[2].springs) spring.rest_length = 0.04;
  return scene;
}

struct Case {
  const char* name;
  std::function<void(Scene&)> change;
};

void set_belt(Scene& scene) {
  scene.vat->walls[4] = Wall{true, {0.5, 0, 0}};
}

void set_surface_tension(Scene& scene) {
  for (Material& material : scene.materials) {
    if (material.liquid) material.liquid->surface_tension = 10;
  }
}

const Case kCases[] = {
    {"gas", [](Scene&) {}},
    {"no_viscosity",
     [](Scene& s) { s.materials[0].liquid->viscosity = s.materials[1].liquid->viscosity = 0; }},
    {"no_slip", set_belt},
    {"no_slip_without_pressure",
     [](Scene& s) {
       set_belt(s);
       s.forces.pressure = false;
     }},
    {"no_pressure", [](Scene& s) { s.forces.pressure = false; }},
    {"restitution", [](Scene& s) { s.default_interface = {.stiffness = 100, .restitution = 0.5}; }},
    {"other_laws",
     [](Scene& s) {
       s.default_interface = {.stiffness = 100, .restitution = 0.5};
       s.interfaces = {
           {{"solid", "vat"}, {.friction = 0.1, .law = InterfaceLaw::projection}, {}},
           {{"water", "solid"}, {.stiffness = 100, .law = InterfaceLaw::lennard_jones}, {}}};
     }},
    {"tait", [](Scene& s) { s.pressure_solver = PressureSolver::tait; }},
    {"tait_no_slip",
     [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       set_belt(s);
     }},
    {"filled",
     [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       s.vat->max = {0.35, 0.15, 0.15};
       ASSERT_TRUE(ForceProbe(s).model().is_filled);
     }},
    {"kept_volume",
     [](Scene& s) {
       s.materials[2].bulk_modulus = 1e4;
       s.bodies[2].springs.clear();
       s.bodies[2].shape = BoxShape{{0, 0, 0}, {0.15, 0.15, 0.15}};
       s.bodies[2].spacing = 0.05;
       s.bodies[2].displacement_field = VectorField{Vec3::Zero(), 0.1 * Mat3::Identity(), {}};
     }},
    {"curvature",
     [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       set_surface_tension(s);
     }},
    {"cohesion",
     [](Scene& s) {
       s.pressure_solver = PressureSolver::tait;
       s.surface_model = SurfaceModel::cohesion;
       set_surface_tension(s);
     }},
    {"incompressible", [](Scene& s) { s.pressure_solver = PressureSolver::incompressible; }}};

TEST(StepColumns, AreReadAndWrittenAsDeclared) {
  for (const Case& c : kCases) {
    SCOPED_TRACE(c.name);
    Scene scene = crowded_scene();
    c.change(scene);
    expect_declared(scene);
  }
}

TEST(StepColumns, OfACollapsedLiquidAreCutOffAndFailTheStep) {
  const auto count = static_cast<int>(1.5 * std::sqrt(max_pairs(1)));
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(1e-6 * i, 0, 0);
  Scene scene =
      make_scene(IntegratorId::velocity_verlet, 1e-3, {make_liquid("water", 1000, {100, 0, 0.1})});
  scene.bodies = {make_body("drop", BodyKind::liquid, "water", make_particles(points, 0.1), 0.05)};
  const auto model = compile_scene(scene);
  Columns columns{initial_state(*model), {}};
  for (const Stage& stage : model->plan.stages) run(stage, *model, columns);
  EXPECT_TRUE(columns.work.of<LiquidScratch>().too_many_pairs);
  EXPECT_TRUE(columns.state.forces.particle[0].hasNaN());
  std::size_t pairs = 0;
  for (const PairBlock& block : columns.work.of<LiquidScratch>().liquid_pairs)
    pairs += block.slots.size();
  EXPECT_LT(static_cast<Real>(pairs), 1.3 * static_cast<Real>(max_pairs(points.size())));
}

}  // namespace
}  // namespace vat::test::step_columns_test
