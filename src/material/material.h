// Hyperelastic materials: an energy density of the deformation gradient F and its two derivatives.
#pragma once
#include <array>
#include <bit>
#include <concepts>
#include <cstddef>
#include <span>

#include "base/compat.h"
#include "math/pack.h"
#include "math/small.h"

namespace aspic {

// pk1 and hessian are defined where psi is finite.
template <class M, class T>
concept MaterialOver = requires(const Mat3<T> F, const typename M::template Params<T> p) {
  { M::psi(F, p) } -> std::same_as<T>;            // energy density         [J/m^3]
  { M::pk1(F, p) } -> std::same_as<Mat3<T>>;      // P = dpsi/dF            [Pa]
  { M::hessian(F, p) } -> std::same_as<Mat9<T>>;  // d vec(P) / d vec(F)    [Pa]
};

template <class M>
concept Material = MaterialOver<M, double> && MaterialOver<M, Pack>;

// Params<T> is an aggregate of T only, so that it can be accessed as an array of T.
template <class M>
inline constexpr std::size_t kParameterCount = sizeof(typename M::template Params<double>) / sizeof(double);

template <class M, class T>
using ParameterArray = std::array<T, kParameterCount<M>>;

// Converts parameters to another scalar: double to Pack (in all lanes) or to Jet (as constants).
template <class M, class To, class From = double>
typename M::template Params<To> broadcast_params(const typename M::template Params<From>& p) {
  const auto from = aspic::bit_cast<ParameterArray<M, From>>(p);
  ParameterArray<M, To> to;
  for (std::size_t k = 0; k < from.size(); ++k) to[k] = To(from[k]);
  return aspic::bit_cast<typename M::template Params<To>>(to);
}

// Packs one parameter set per lane: 1 to kPackWidth sets; the last one also fills the remaining lanes.
template <class M>
typename M::template Params<Pack> pack_params(std::span<const typename M::template Params<double>> lanes) {
  ParameterArray<M, Pack> to;
  for (int lane = 0; lane < kPackWidth; ++lane) {
    const std::size_t i = static_cast<std::size_t>(lane) < lanes.size() ? lane : lanes.size() - 1;
    const auto from = aspic::bit_cast<ParameterArray<M, double>>(lanes[i]);
    for (std::size_t k = 0; k < to.size(); ++k) to[k].set(lane, from[k]);
  }
  return aspic::bit_cast<typename M::template Params<Pack>>(to);
}

}  // namespace aspic
