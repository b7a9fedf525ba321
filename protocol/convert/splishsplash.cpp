#include "protocol/convert/splishsplash.h"

#include <algorithm>
#include <cmath>

#include "protocol/convert/conversion.h"

namespace vat {
namespace conversion {
namespace {

constexpr const char* kPrograms = "a setting of the program, not of the scene";

/// The members of the pressure solver: in a block with its name, or in the configuration.
constexpr const char* kSolverBlocks[] = {
    "WCSPH", "PCISPH", "PBF", "IISPH", "DFSPH", "Projective Fluids", "ICSPH"};
constexpr std::size_t kWcsph = 0;
constexpr std::size_t kDfsph = 4;

void omit_settings_of_program(SourceObject& configuration) {
  configuration.omit({"pause",
                      "pauseAt",
                      "stopAt",
                      "cameraPosition",
                      "cameraLookat",
                      "renderWalls",
                      "numberOfStepsPerRenderUpdate",
                      "enablePartioExport",
                      "enableVTKExport",
                      "enableRigidBodyExport",
                      "enableRigidBodyVTKExport",
                      "dataExportFPS",
                      "particleAttributes",
                      "enableStateExport",
                      "stateExportFPS",
                      "enableZSort",
                      "scriptFile",
                      "renderMaxVelocity",
                      "renderMinVelocity",
                      "activateVSync",
                      "renderBoundingBox"},
                     kPrograms);
  configuration.omit({"boundaryHandlingMethod"}, "vat has its own treatment of walls and bodies");
  configuration.omit({"kernel", "gradKernel"}, "the scene has vat's default kernel");
  configuration.omit({"cflFactor", "cflMinTimeStepSize"}, "vat has its own limits of a step");
  configuration.omit({"minIterations", "velocityUpdateMethod", "lambda", "pressureClamping"},
                     "vat has its own solver");
  configuration.omit({"enableDivergenceSolver"}, "the solver of vat always includes it");
  configuration.omit({"boundingBoxMin", "boundingBoxMax"}, "vat keeps particles without a box");
}

/// The error tolerances of DFSPH are in percent. Other methods define their errors in another way.
void read_tolerances(SourceObject& solver, Json& tolerances) {
  if (solver.has("maxError")) {
    tolerances["density_tolerance"] = tidy(solver.real("maxError", 1e-8, 10, 0.01) / 100);
  }
  if (solver.has("maxErrorV")) {
    tolerances["divergence_tolerance"] = tidy(solver.real("maxErrorV", 1e-8, 10, 0.1) / 100);
  }
  if (solver.has("maxIterations")) {
    tolerances["most_iterations"] = solver.count("maxIterations", 2, 10'000, 100);
  }
  solver.omit({"maxIterationsV"}, "maxIterations applies to both solves");
}

void read_solver(SourceObject& solver, Conversion& conversion, Json& tolerances,
                 std::pair<Real, Real>& equation) {
  if (conversion.method == kDfsph) read_tolerances(solver, tolerances);
  if (conversion.method == kWcsph) {
    equation.first = solver.real("stiffness", 0, 1e12, equation.first);
    equation.second = solver.real("exponent", 1e-3, 100, equation.second);
  }
  solver.omit({"maxError", "maxErrorV", "maxIterations", "maxIterationsV", "minIterations",
               "stiffness", "exponent", "velocityUpdateMethod", "lambda", "pressureClamping"},
              "vat has its own solver");
  solver.omit({"enableDivergenceSolver"}, "the solver of vat always includes it");
}

void read_members(SourceObject& configuration, Conversion& conversion) {
  conversion.is_flat = configuration.boolean("sim2D", false);
  conversion.spacing = 2 * configuration.real("particleRadius", kMinLength, kMaxLength / 8, 0.025);
  conversion.method = configuration.count("simulationMethod", 0, 6, kDfsph);
  const Vec3 gravity = z_up(configuration.vector("gravitation", kMaxGravity, Vec3(0, -9.81, 0)));
  if (gravity != Vec3(0, 0, -9.81)) conversion.scene["gravity"] = tidy_json(gravity);
  if (conversion.is_flat) conversion.scene["dimensions"] = 2U;
}

void read_solvers(SourceObject& configuration, Conversion& conversion) {
  Json tolerances = Json::object();
  std::pair<Real, Real> equation(50'000, 7);  // stiffness [Pa] and exponent
  for (std::size_t i = 0; i < std::size(kSolverBlocks); ++i) {
    const char* block = kSolverBlocks[i];
    if (!configuration.has(block)) continue;
    if (i != conversion.method) {
      configuration.omit({block}, "belongs to another simulationMethod");
      continue;
    }
    const Json* members = configuration.member(block);
    SourceObject solver(*members, configuration.path_of(block), conversion.report);
    read_solver(solver, conversion, tolerances, equation);
    solver.omit_rest();
  }
  read_solver(configuration, conversion, tolerances, equation);
  conversion.pressure_constant = equation.first * equation.second;
  if (conversion.method == kWcsph) return;
  conversion.scene["pressure_solver"] = "incompressible";
  if (!tolerances.empty()) conversion.scene["incompressible"] = std::move(tolerances);
}

/// Returns the scene's object with the general settings, or an empty object.
const Json& configuration_of(const Json& document) {
  static const Json kEmpty = Json::object();
  const auto found = document.find("Configuration");
  return found == document.end() ? kEmpty : *found;
}

/// Returns the path of the source for a path of the scene.
std::string source_of(const std::string& path, const Conversion& conversion) {
  const auto in = [&](std::string_view list, const std::vector<std::string>& sources) {
    if (!path.starts_with(list)) return std::string();
    const std::size_t index = std::strtoul(path.c_str() + list.size(), nullptr, 10);
    return index < sources.size() ? sources[index] : std::string();
  };
  std::string source = in("/bodies/", conversion.body_sources);
  if (source.empty()) source = in("/materials/", conversion.material_sources);
  if (source.empty()) source = in("/emitters/", conversion.emitter_sources);
  if (source.empty() && path.starts_with("/numerics")) source = "/Configuration";
  return source;
}

/// Returns the errors of the resulting scene, with the paths of the source.
Errors errors_of_source(const Errors& errors, const Conversion& conversion) {
  Errors mapped;
  for (Error error : errors) {
    const std::string source = source_of(error.path, conversion);
    error.message = "as " + error.path + " of the scene: " + error.message;
    error.path = source;
    mapped.push_back(std::move(error));
  }
  return mapped;
}

void omit_other_parts(const Json& document, Conversion& conversion) {
  constexpr const char* kRead[] = {"Configuration", "Materials", "FluidBlocks", "FluidModels",
                                   "RigidBodies",   "Emitters",  "Name"};
  for (const auto& [key, value] : document.items()) {
    const bool is_read =
        std::ranges::find(kRead, key) != std::end(kRead) || conversion.materials.contains(key);
    if (is_read) continue;
    const char* reason = "vat does not know this member";
    if (key == "AnimationFields") reason = "vat has no fields that change particles";
    if (key == "Simulation") reason = "settings of another solver of rigid bodies";
    if (key.ends_with("Joints")) reason = "vat has no joints";
    if (key == "TriangleModels" || key == "TetModels") reason = "vat does not read these models";
    conversion.report.omit(pointer_to("", key), reason);
  }
}

}  // namespace

void read_configuration(const Json& document, Conversion& conversion) {
  SourceObject configuration(configuration_of(document), "/Configuration", conversion.report);
  read_members(configuration, conversion);
  read_solvers(configuration, conversion);
  const bool is_adaptive = configuration.count("cflMethod", 0, 2, 1) != 0;
  const char* step = is_adaptive ? "cflMaxTimeStepSize" : "timeStepSize";
  conversion.longest_step =
      configuration.real(step, kMinStep, kMaxStep, is_adaptive ? 0.005 : 0.001);
  conversion.is_adaptive = is_adaptive;
  configuration.omit({"timeStepSize"}, "the first step; steps are adaptive");
  configuration.omit({"cflMaxTimeStepSize"}, "steps are fixed");
  omit_settings_of_program(configuration);
  configuration.omit_rest();
}

void add_numerics(Conversion& conversion) {
  Real step = conversion.longest_step;
  // At most one layer of an emitter flows in a step.
  if (conversion.fastest_emitter > 0) {
    step = std::min(step, 0.5 * conversion.spacing / conversion.fastest_emitter);
  }
  step = tidy(step, 6);
  constexpr Real kTick = 0.02;  // [s] about
  const Real steps = std::max<Real>(1, std::round(kTick / step));
  conversion.scene["numerics"] = {
      {"integrator", conversion.method == kWcsph ? "velocity_verlet" : "symplectic_euler"},
      {"step", step},
      {"tick", tidy(steps * step)},
      {"control", conversion.is_adaptive ? "adaptive" : "fixed"}};
}

}  // namespace conversion

Result<ConvertedScene> convert_splishsplash(const Json& document, const MeshSource& meshes) {
  using namespace conversion;
  if (!document.is_object()) return Error{"wrong_type", "", "must be an object"};
  Conversion conversion(meshes);
  conversion.scene = {{"format", "vat.scene/1"}, {"bodies", Json::array()}};
  const auto name = document.find("Name");
  if (name != document.end() && name->is_string()) conversion.scene["title"] = *name;
  read_configuration(document, conversion);
  read_materials(document, conversion);
  read_blocks(document, conversion);
  read_models(document, conversion);
  read_emitters(document, conversion);
  read_rigid_bodies(document, conversion);
  limit_emitters(conversion);
  add_numerics(conversion);
  omit_other_parts(document, conversion);
  if (!conversion.report.errors.empty()) return conversion.report.errors;
  const std::size_t bytes = scene_text(conversion.scene).size();
  if (bytes > kSceneLimits.bytes) {
    return Error{"too_large", "",
                 "the scene with its meshes has " + std::to_string(bytes) + " bytes; at most " +
                     std::to_string(kSceneLimits.bytes) + " are allowed"};
  }
  const MeshSource no_files = [](const std::string& file) -> Result<std::string> {
    return Error{"no_such_file", "", file};
  };
  const Result<Scene> scene = read_scene(conversion.scene, no_files);
  if (!scene) return errors_of_source(scene.errors(), conversion);
  return ConvertedScene{std::move(conversion.scene), std::move(conversion.report.omissions)};
}

}  // namespace vat
