#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <thread>

#include "tests/support/memory/allocation_counter.h"
#include "tests/support/shaken_vat.h"

namespace vat::allocation_test {
namespace {

using namespace test;

TEST(Allocation, IsCounted) {
  const std::size_t before = allocation_count();
  const std::vector<int> numbers(1000);
  EXPECT_EQ(allocation_count(), before + 1);
  EXPECT_EQ(numbers.back(), 0);
}

/// A task runner whose threads exist from the start and spin while they wait. It does not allocate.
class WaitingRunner : public TaskRunner {
 public:
  WaitingRunner() {
    for (std::thread& helper : helpers_) helper = std::thread([this] { help(); });
  }
  ~WaitingRunner() override {
    is_over_ = true;
    ++jobs_;
    jobs_.notify_all();
    for (std::thread& helper : helpers_) helper.join();
  }

  void run(std::size_t block_count, const std::function<void(std::size_t)>& block) override {
    block_ = &block;
    next_ = block_count;
    at_work_ = static_cast<int>(helpers_.size());
    ++jobs_;
    jobs_.notify_all();
    do_blocks();
    for (int left = at_work_; left > 0; left = at_work_) at_work_.wait(left);
    ++runs_;
  }
  std::size_t thread_count() const override { return helpers_.size() + 1; }
  std::size_t runs() const { return runs_; }

 private:
  void do_blocks() {
    for (std::ptrdiff_t n = --next_; n >= 0; n = --next_) (*block_)(static_cast<std::size_t>(n));
  }
  void help() {
    for (int seen = 0; !is_over_; do_blocks(), --at_work_, at_work_.notify_one()) {
      jobs_.wait(seen++);
      if (is_over_) return;
    }
  }

  const std::function<void(std::size_t)>* block_ = nullptr;
  std::atomic<std::ptrdiff_t> next_ = 0;
  std::atomic<int> at_work_ = 0;
  std::atomic<int> jobs_ = 0;
  std::atomic<bool> is_over_ = false;
  std::size_t runs_ = 0;
  std::array<std::thread, 3> helpers_;
};

/// A cube of viscous liquid on the floor of a vat. Its speed of sound is 10 m/s.
Scene make_wet_vat(PressureSolver solver, int width = 5) {
  constexpr Real kSpacing = 0.1;
  const bool is_tait = solver == PressureSolver::tait;
  Scene scene =
      make_scene(is_tait ? IntegratorId::velocity_verlet : IntegratorId::symplectic_euler, 2e-3);
  scene.pressure_solver = solver;
  scene.materials = {make_liquid("honey", 1000, {100, 1000, 3 * kSpacing})};
  scene.bodies = {make_body("honey", BodyKind::liquid, "honey",
                            make_particles(make_lattice(width, width, width, kSpacing), 1),
                            kSpacing / 2)};
  scene.vat = Vat{{-1, -1, -kSpacing * width / 2}, {1, 1, 1}, true, {}, {}};
  return scene;
}

/// Runs until every buffer has its final size, then expects no allocation.
void expect_no_allocations(Simulation& simulation, std::uint32_t steps) {
  for (int n = 0; n < 2; ++n) {  // the second call copies the additions of the first call
    ASSERT_TRUE(simulation.advance(steps).events.empty());
  }
  const std::size_t before = allocation_count();
  EXPECT_GE(simulation.advance(150).steps, 150U);
  EXPECT_EQ(allocation_count(), before);
}

TEST(Allocation, NoneInASteadyStepOfAllKinds) {
  std::vector<Scene> scenes;
  for (const IntegratorId integrator : kIntegrators) scenes.push_back(make_shaken_vat(integrator));
  for (const StepControl control : {StepControl::adaptive, StepControl::local}) {
    scenes.push_back(make_shaken_vat(IntegratorId::velocity_verlet));
    scenes.back().numerics.control = control;
  }
  scenes.push_back(make_shaken_vat(IntegratorId::symplectic_euler));
  scenes.back().pressure_solver = PressureSolver::incompressible;
  for (Scene& scene : scenes) {
    SCOPED_TRACE(testing::Message()
                 << to_string(scene.numerics.integrator) << ' ' << to_string(scene.numerics.control)
                 << ' ' << to_string(scene.pressure_solver));
    scene.vat->motion.reset();
    Simulation simulation = make_simulation(scene);
    if (scene.numerics.control == StepControl::fixed) {
      ASSERT_TRUE(simulation.grab_start(1, simulation.bodies()[2].id, 0, {0, 0, 0.3}).ok());
    }
    expect_no_allocations(simulation, 1500);
  }
}

TEST(Allocation, NoneInASteadyStepOfViscousLiquids) {
  Scene wet = make_wet_vat(PressureSolver::tait);
  std::vector<Scene> scenes = {wet, make_wet_vat(PressureSolver::incompressible)};
  wet.materials[0].liquid->surface_tension = 10;
  for (const SurfaceModel model : {SurfaceModel::curvature, SurfaceModel::cohesion}) {
    wet.surface_model = model;
    scenes.push_back(wet);
  }
  for (const Scene& scene : scenes) {
    Simulation simulation = make_simulation(scene);
    expect_no_allocations(simulation, 300);
  }
}

TEST(Allocation, NoneInASteadyStepOfSeveralThreads) {
  for (const PressureSolver solver :
       {PressureSolver::gas, PressureSolver::tait, PressureSolver::incompressible}) {
    WaitingRunner runner;
    SCOPED_TRACE(to_string(solver));
    Simulation simulation = make_simulation(make_wet_vat(solver, 8), &runner);  // several blocks
    expect_no_allocations(simulation, 250);
    EXPECT_GT(runner.runs(), 600U);
  }
}

}  // namespace
}  // namespace vat::allocation_test
