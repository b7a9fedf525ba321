#include "tests/bench/codec/recording.h"

#include <cmath>
#include <stdexcept>

#include "core/threads/thread_pool.h"
#include "protocol/scene/scene_json.h"
#include "server/cli/common/scene_argument.h"
#include "tests/bench/speed/scenes.h"

namespace vat::bench {
namespace {

/// Sets the tick to the frame interval.
Scene at_frame_rate(Scene scene) {
  Numerics& numerics = scene.numerics;
  numerics.tick = 1 / kFrameRate;
  const bool is_fixed = numerics.control == StepControl::fixed;
  numerics.step =
      is_fixed ? numerics.tick / std::ceil(numerics.tick / numerics.step) : numerics.tick;
  return scene;
}

CodecScene dam_break_of(std::string name, int edge, PressureSolver solver, Real seconds) {
  return {std::move(name), at_frame_rate(peer_dam_break(edge, solver)), 1.0 / edge, 0, seconds};
}

Scene catalogue_scene(const std::string& name) {
  Result<Scene> scene = load_scene(name, VAT_DEFAULT_SCENES_DIR);
  if (!scene) throw std::runtime_error(name + " cannot be read");
  return at_frame_rate(std::move(scene).value());
}

/// Figure 2 of the article with its vat at rest, so that all bodies come to rest.
Scene figure_2_in_a_still_vat() {
  Scene scene = catalogue_scene("sliding-vat-liquid");
  scene.vat->motion.reset();
  return scene;
}

void advance(Simulation& simulation, const std::string& name) {
  if (simulation.advance(simulation.steps_per_tick()).failed) {
    throw std::runtime_error(name + ": a step failed");
  }
}

}  // namespace

std::vector<CodecScene> codec_scenes(bool quick) {
  constexpr Real kPaperSpacing = 0.04;
  constexpr Real kPoolSpacing = 0.04;
  const Real run = quick ? 1 : 4;
  const Real look = quick ? 0.5 : 2;
  CodecScene asleep{"pool-asleep", at_frame_rate(pool(PressureSolver::tait)), kPoolSpacing, 4,
                    look};
  asleep.scene.sleeping = Sleeping{};
  asleep.rests = true;
  CodecScene figure_2_asleep{"figure-2-asleep", figure_2_in_a_still_vat(), kPaperSpacing, 12, look};
  figure_2_asleep.scene.sleeping = Sleeping{};
  figure_2_asleep.rests = true;
  CodecScene million = dam_break_of("dam-break-1m", quick ? 40 : 100, PressureSolver::tait, 0.3);
  million.is_large = true;
  return {
      dam_break_of("dam-break-10k", quick ? 12 : 22, PressureSolver::tait, run),
      dam_break_of("dam-break-30k", quick ? 14 : 31, PressureSolver::tait, run),
      dam_break_of("dam-break-30k-incompressible", quick ? 14 : 31, PressureSolver::incompressible,
                   run),
      {"pool-settled", at_frame_rate(pool(PressureSolver::tait)), kPoolSpacing, 2, look},
      std::move(asleep),
      {"figure-1", catalogue_scene("sliding-vat-solids"), kPaperSpacing, 0, run},
      {"figure-2", catalogue_scene("sliding-vat-liquid"), kPaperSpacing, 0, run},
      {"figure-2-settled", figure_2_in_a_still_vat(), kPaperSpacing, quick ? Real{8} : 40, look},
      std::move(figure_2_asleep),
      std::move(million),
  };
}

Recording record(const CodecScene& scene, std::size_t threads) {
  ThreadPoolRunner runner(threads);
  Result<Simulation> created = Simulation::create(scene.scene, &runner);
  if (!created) throw std::runtime_error(scene.name + ": " + created.errors().front().message);
  Simulation simulation = std::move(created).value();
  Recording recording;
  recording.particles = simulation.particle_count();
  for (auto tick = std::lround(scene.begin * kFrameRate); tick > 0; --tick) {
    advance(simulation, scene.name);
  }
  if (scene.rests && simulation.sleeping_body_count() < simulation.bodies().size()) {
    throw std::runtime_error(scene.name + ": not at rest");
  }
  for (auto tick = std::lround(scene.seconds * kFrameRate); tick > 0; --tick) {
    advance(simulation, scene.name);
    recording.states.push_back(publish(simulation));
    FrameHeader& header = recording.states.back().header;
    header.number = static_cast<std::uint32_t>(recording.states.size());
    header.epoch = 1;
    header.tick = header.number;
  }
  return recording;
}

}  // namespace vat::bench
