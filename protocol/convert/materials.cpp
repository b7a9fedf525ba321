#include <algorithm>
#include <cmath>

#include "protocol/convert/conversion.h"

namespace vat::conversion {
namespace {

constexpr const char* kDefaultId = "Fluid";
constexpr const char* kMethodReason = "vat has no counterpart of this method";

/// Returns the ids of blocks, models and emitters in alphabetical order.
std::set<std::string> used_ids(const Json& document, Conversion& conversion) {
  std::set<std::string> ids;
  for (const char* list : {"FluidBlocks", "FluidModels", "Emitters"}) {
    for_each_in(document, list, conversion, [&](const Json& element, const std::string&) {
      if (!element.is_object()) return;  // its reader adds the error
      const auto id = element.find("id");
      ids.insert(id != element.end() && id->is_string() ? id->get<std::string>() : kDefaultId);
    });
  }
  return ids;
}

void omit_solver_settings(SourceObject& object) {
  object.omit({"viscoMaxIter", "viscoMaxError", "viscoMaxIterOmega", "viscoMaxErrorOmega",
               "elasticityMaxIter", "elasticityMaxError", "maxNeighbors"},
              "vat selects the tolerances of its solvers");
  object.omit({"viscosityBoundary"}, "walls slip unless they are no_slip");
}

/// A member of the material, or of the block with the name of its method.
class MethodMembers {
 public:
  MethodMembers(SourceObject& material, const char* block, Report& report) : outer_(&material) {
    const Json* members = material.member(block);
    if (members != nullptr) inner_.emplace(*members, material.path_of(block), report);
  }
  SourceObject& with(const char* key) { return inner_ && inner_->has(key) ? *inner_ : *outer_; }
  void finish() {
    if (!inner_) return;
    omit_solver_settings(*inner_);
    inner_->omit_rest();
  }

 private:
  SourceObject* outer_;
  std::optional<SourceObject> inner_;
};

/// Returns the name of the block of a method whose coefficient is the kinematic viscosity. The
/// numbers of the methods changed with version 2.9, which introduced the blocks.
const char* viscosity_block(SourceObject& material, std::size_t method) {
  constexpr const char* kWeiler = "Weiler et al. 2018";
  if (method == 1) return "Standard viscosity";
  if (method == 6 && material.has(kWeiler)) return kWeiler;
  if (method == 7) return kWeiler;
  return nullptr;
}

/// Returns the dynamic viscosity [Pa s].
Real read_viscosity(SourceObject& material, Real density, Report& report) {
  const std::size_t method = material.count("viscosityMethod", 0, 100, 1);
  const char* block = viscosity_block(material, method);
  if (block == nullptr) {
    if (method > 0) {
      report.omit(material.path_of("viscosityMethod"),
                  "the coefficient of this method is not a viscosity; the liquid has the viscosity "
                  "0 Pa s");
    }
    material.omit({"viscosity"}, "belongs to the omitted method");
    return 0;
  }
  MethodMembers members(material, block, report);
  const Real kinematic = members.with("viscosity").real("viscosity", 0, kMaxViscosity, 0.01);
  members.finish();
  return kinematic * density;
}

/// Returns the springs of a lattice with this elasticity. A cubic lattice with springs of equal
/// stiffness k along axes and face diagonals is isotropic, with Poisson's ratio 1/4 and Young's
/// modulus 2.5 k / spacing. In two dimensions, the diagonal springs have k, the others 2 k, and the
/// modulus is 8/3 k.
Json lattice_springs(const Conversion& conversion, Real modulus) {
  const Real along = conversion.is_flat ? 0.75 * modulus : 0.4 * modulus * conversion.spacing;
  const Real diagonal = conversion.is_flat ? along / 2 : along;
  return {{"structural", {{"stiffness", tidy(along)}}}, {"shear", {{"stiffness", tidy(diagonal)}}}};
}

/// Adds springs if the material has an elasticity method.
void read_elasticity(SourceObject& material, Conversion& conversion, LiquidMaterial& known,
                     Json& json) {
  constexpr const char* kBlocks[] = {"Becker et al. 2009", "Peer et al. 2018",
                                     "Kugelstadt et al. 2021"};
  const std::size_t method = material.count("elasticityMethod", 0, 3, 0);
  if (method == 0) {
    material.omit({"youngsModulus", "poissonsRatio", "alpha"}, "the material has no elasticity");
    return;
  }
  known.is_elastic = true;
  MethodMembers members(material, kBlocks[method - 1], conversion.report);
  const Real modulus = members.with("youngsModulus").real("youngsModulus", 0, 1e12, 1e5);
  json["springs"] = lattice_springs(conversion, modulus);
  SourceObject& ratio = members.with("poissonsRatio");
  if (ratio.real("poissonsRatio", -1, 0.5, 0.25) != 0.25) {
    conversion.report.omit(ratio.path_of("poissonsRatio"),
                           "springs on a lattice have the ratio 0.25");
  }
  members.with("alpha").omit({"alpha"}, "springs have no zero-energy modes");
  for (const char* key : {"fixedBoxMin", "fixedBoxMax"}) {
    members.with(key).omit({key}, "bodies on a lattice have no fixed particles");
  }
  members.finish();
}

void omit_methods(SourceObject& material) {
  material.omit({"surfaceTensionMethod", "surfaceTension"},
                "the coefficient is not in N/m; set surface_tension of the liquid instead");
  material.omit({"Becker & Teschner 2007", "Akinci et al. 2013", "He et al. 2014",
                 "Jeske et al. 2023", "Zorilla, Ritter, et al. 2020"},
                "belongs to surfaceTensionMethod");
  material.omit(
      {"vorticityMethod", "vorticity", "viscosityOmega", "inertiaInverse", "Bender et al. 2017",
       "Vorticity confinement", "Liu et al. 2021", "dragMethod", "drag", "Macklin et al. 2014",
       "Gissler et al. 2017", "XSPH", "xsph", "xsphBoundary"},
      kMethodReason);
  omit_solver_settings(material);
  material.omit({"Bender and Koschier 2017", "Peer et al. 2015", "Peer et al. 2016",
                 "Takahashi et al. 2015 (improved)", "Weiler et al. 2018", "Standard viscosity"},
                "belongs to another viscosityMethod, or to an omitted one");
  material.omit({"colorField", "colorMapType", "renderMinValue", "renderMaxValue", "visible"},
                "a setting of pictures");
  material.omit({"emitterReuseParticles", "emitterBoxMin", "emitterBoxMax"},
                "particles are not reused; drains can remove particles");
}

void add_material(const Json& source, const std::string& path, const std::string& id,
                  Conversion& conversion) {
  SourceObject material(source, path, conversion.report);
  material.text("id", id);
  const Real density = material.real("density0", kMinDensity, kMaxDensity, 1000);
  Json json = {{"name", id}, {"density", tidy(density)}};
  LiquidMaterial known{id};
  known.most_emitted = material.count("maxEmitterParticles", 0, 4'294'967'295, 10'000);
  read_elasticity(material, conversion, known, json);
  const Real viscosity = read_viscosity(material, density, conversion.report);
  if (!known.is_elastic) {
    const bool is_compressible = conversion.method == 0;
    json["liquid"] = {
        {"stiffness", is_compressible ? tidy(conversion.pressure_constant / density) : 0},
        {"viscosity", tidy(viscosity)},
        {"support_radius", tidy(2 * conversion.spacing)}};
  }
  omit_methods(material);
  material.omit_rest();
  conversion.materials.emplace(id, known);
  conversion.scene["materials"].push_back(std::move(json));
  conversion.material_sources.push_back(path);
}

}  // namespace

void read_materials(const Json& document, Conversion& conversion) {
  std::set<std::string> missing = used_ids(document, conversion);
  conversion.scene["materials"] = Json::array();
  for_each_in(document, "Materials", conversion, [&](const Json& source, const std::string& path) {
    SourceObject object(source, path, conversion.report);
    const std::string id = object.text("id", kDefaultId);
    if (missing.erase(id) > 0) {
      add_material(source, path, id, conversion);
    } else {
      conversion.report.omit(path, conversion.materials.contains(id)
                                       ? "an earlier material has this id"
                                       : "no block, model or emitter has this id");
    }
  });
  // Old files have materials at the top level. Without a material, the defaults apply.
  for (const std::string& id : missing) {
    const auto found = document.find(id);
    const bool is_named = found != document.end() && found->is_object();
    add_material(is_named ? *found : Json::object(), pointer_to("", is_named ? id : "Materials"),
                 id, conversion);
  }
}

}  // namespace vat::conversion
