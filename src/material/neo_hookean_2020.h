// Neo-Hookean model of earlier course programs: psi = mu/2 (J^(-2/3) I1 - 3) + lambda/2 (J - 1)^2; +inf for J <= 0.
// With lambda = lambda_L, Poisson's ratio would be too small; with lambda = K, it is neo_hookean_isochoric.
#pragma once
#include "material/neo_hookean_isochoric.h"

namespace aspic {

struct NeoHookean2020Law : NeoHookeanIsochoricLaw {
  static MaterialInfo info() {
    MaterialInfo info = NeoHookeanIsochoricLaw::info();
    info.name = "neo_hookean_2020";
    info.formula = "mu/2 (J^(-2/3) I1 - 3) + la/2 (J - 1)^2 with mu = mu_L, la = la_L + 2/3 mu_L";
    info.tex = {R"tex(\psi = \tfrac{\mu}{2} (\bar I_1 - 3) + \tfrac{\lambda'}{2} (J - 1)^2)tex",
                R"tex(\bar I_1 = J^{-2/3}\, I_1, \quad \lambda' = \lambda + \tfrac23 \mu)tex",
                R"tex(\psi = \infty \quad (J \le 0))tex"};
    info.remarks =
        "The same as neo_hookean_isochoric once it reproduces E and nu. Programs that put la = la_L are "
        "reproduced by giving this material their mu and la - 2/3 mu. " +
        info.remarks;
    return info;
  }
};

using NeoHookean2020 = FromInvariants<NeoHookean2020Law>;

}  // namespace aspic
