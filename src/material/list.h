// The compile-time list of all materials. A new material is one header and one line here.
#pragma once
#include <string>
#include <string_view>
#include <tuple>
#include <vector>

#include "base/error.h"
#include "material/arap.h"
#include "material/corotated.h"
#include "material/fung.h"
#include "material/linear.h"
#include "material/mooney_rivlin.h"
#include "material/neo_hookean.h"
#include "material/neo_hookean_2020.h"
#include "material/neo_hookean_isochoric.h"
#include "material/neo_hookean_log.h"
#include "material/neo_hookean_log_j2.h"
#include "material/registry.h"
#include "material/spline.h"
#include "material/stable_neo_hookean.h"
#include "material/stvk.h"

namespace aspic {

using MaterialList = std::tuple<  //
    NeoHookean,                   //
    StableNeoHookean,             //
    NeoHookeanLog,                //
    NeoHookeanLogJ2,              //
    NeoHookeanIsochoric,          //
    NeoHookean2020,               //
    Stvk,                         //
    Corotated,                    //
    Arap,                         //
    Linear,                       //
    MooneyRivlin,                 //
    Fung,                         //
    Spline>;

// A material that scenes can name: params() turns small-strain constants into its own, info() describes it.
template <class M>
concept RegisteredMaterial = Material<M> && requires(const MaterialParameters m, const MaterialParametersOver<Pack> p) {
  { M::params(m) } -> std::same_as<typename M::template Params<double>>;
  { M::params(p) } -> std::same_as<typename M::template Params<Pack>>;
  { M::info() } -> std::same_as<MaterialInfo>;
};

// Calls fn.template operator()<M>() for every material, in the order of the list.
template <class Fn>
void for_each_material(Fn&& fn) {
  const auto visit = [&fn]<RegisteredMaterial... M>(std::tuple<M...>*) { (fn.template operator()<M>(), ...); };
  visit(static_cast<MaterialList*>(nullptr));
}

// Calls fn.template operator()<M>() for the material of that name; throws InvalidInput with the nearest known name.
template <class Fn>
void with_material(std::string_view name, Fn&& fn) {
  material_info(name);  // throws when there is none
  for_each_material([&]<class M>() {
    if (M::info().name == name) fn.template operator()<M>();
  });
}

}  // namespace aspic
