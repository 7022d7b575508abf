// Visits all materials at compile time. The list is src/material/materials.cmake.
#pragma once
#include <string_view>

#include "base/error.h"
#include "material/all_materials.h"  // generated from materials.cmake: MaterialList

namespace aspic {

// Material for scenes: params() converts small-strain constants to its own, info() describes it, and reference_energy()
// is its energy density in principal stretches for the default extra parameters.
template <class M>
concept RegisteredMaterial = Material<M> && requires(const MaterialParameters m, const MaterialParametersOver<Pack> p) {
  { M::params(m) } -> std::same_as<typename M::template Params<double>>;
  { M::params(p) } -> std::same_as<typename M::template Params<Pack>>;
  { M::info() } -> std::same_as<MaterialInfo>;
} && requires(const PrincipalStretches s, const ReferenceModuli r) {
  { M::reference_energy(s, r) } -> std::same_as<long double>;
};

// Calls fn.template operator()<M>() for every material in the order of the list.
template <class Fn>
void for_each_material(Fn&& fn) {
  const auto visit = [&fn]<RegisteredMaterial... M>(std::tuple<M...>*) { (fn.template operator()<M>(), ...); };
  visit(static_cast<MaterialList*>(nullptr));
}

// Calls fn.template operator()<M>() for the named material. Throws InvalidInput with the nearest known name.
template <class Fn>
void with_material(std::string_view name, Fn&& fn) {
  material_info(name);  // throws for an unknown name
  for_each_material([&]<class M>() {
    if (M::info().name == name) fn.template operator()<M>();
  });
}

}  // namespace aspic
