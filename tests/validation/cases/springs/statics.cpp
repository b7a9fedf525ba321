#include "tests/validation/cases.h"
#include "tests/validation/reference.h"
#include "tests/validation/relax.h"

namespace vat::validation {

namespace {

constexpr Real kResidual = 1e-9;  // [N]

const std::vector<Vec3>& equilibrium_nodes(const Equilibrium& rest) {
  return std::get<ParticleShape>(rest.scene.bodies[0].shape).positions;
}

/// Adds a length of a body in equilibrium, with a relative tolerance of 1e-6.
void add_length(Sheet& sheet, const Equilibrium& rest, const std::string& metric, Real expected,
                Real measured) {
  Row row = rest.origin;
  row.metric = metric + " [m]";
  row.reference = expected;
  row.measured = measured;
  row.tolerance = within_relative(1e-6, "equilibrium to a force of 1e-9 N");
  sheet.add(std::move(row));
}

void run_chain(Sheet& sheet) {
  const Equilibrium rest = relax(load_scene("DEF-3a"), kResidual, sheet);
  const Json& expected = reference_at("/deformable/DEF-3a/y");
  for (std::size_t i = 0; i < expected.size(); ++i) {
    add_length(sheet, rest, "height of node " + std::to_string(i + 1), expected[i].get<Real>(),
               equilibrium_nodes(rest)[i + 1].z());
  }
}

void run_catenary(Sheet& sheet) {
  const Equilibrium rest = relax(load_scene("DEF-3b"), kResidual, sheet);
  const std::string expected = "/deformable/DEF-3b/";
  add_length(sheet, rest, "height of the middle", reference(expected + "mid_y"),
             equilibrium_nodes(rest)[10].z());
  add_length(sheet, rest, "place of node 5", reference(expected + "node5/0"),
             equilibrium_nodes(rest)[5].x());
  add_length(sheet, rest, "height of node 5", reference(expected + "node5/1"),
             equilibrium_nodes(rest)[5].z());
  Row tension = rest.origin;
  tension.metric = "tension at the ends [N]";
  tension.reference = reference(expected + "end_tension");
  tension.measured = reference(expected + "k") *
                     ((equilibrium_nodes(rest)[1] - equilibrium_nodes(rest)[0]).norm() -
                      reference(expected + "l"));
  tension.tolerance = within_relative(1e-6, "equilibrium to a force of 1e-9 N");
  sheet.add(std::move(tension));
}

void run_cloth(Sheet& sheet) {
  const Equilibrium rest = relax(load_scene("DEF-3c"), kResidual, sheet);
  const auto node = [&](std::size_t i, std::size_t j) {
    return equilibrium_nodes(rest)[i * 11 + j];
  };
  const std::string expected = "/deformable/DEF-3c/";
  add_length(sheet, rest, "height of the centre", reference(expected + "centre_z"), node(5, 5).z());
  const Vec3 edge = reference_vector(expected + "edge_mid");
  const Vec3 inner = reference_vector(expected + "q_node_2_2");
  add_length(sheet, rest, "inward displacement of an edge's centre", edge.x(), node(0, 5).x());
  add_length(sheet, rest, "displacement of an edge's centre along the edge", edge.y(),
             node(0, 5).y());
  add_length(sheet, rest, "height of an edge's centre", edge.z(), node(0, 5).z());
  add_length(sheet, rest, "place of node (2, 2)", inner.x(), node(2, 2).x());
  add_length(sheet, rest, "height of node (2, 2)", inner.z(), node(2, 2).z());
}

}  // namespace

std::vector<Case> static_cases() {
  const std::string kind = "deformable";
  return {
      {"DEF-3a", "chain hanging from one end", kind, {"DEF-3a"}, run_chain},
      {"DEF-3b", "chain hanging from both ends", kind, {"DEF-3b"}, run_catenary},
      {"DEF-3c", "cloth hanging from its corners", kind, {"DEF-3c"}, run_cloth},
  };
}

}  // namespace vat::validation
