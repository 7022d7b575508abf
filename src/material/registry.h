// The materials of the library and their parameters.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "material/lame.h"

namespace aspic {

inline constexpr int kMaxExtraParameters = 13;

// Parameters of one tet: small-strain constants [Pa], and further parameters in the order of MaterialInfo::extra.
template <class T>
struct MaterialParametersOver {
  LameOver<T> lame;
  std::array<T, kMaxExtraParameters> extra{};
};
using MaterialParameters = MaterialParametersOver<double>;

// A parameter of a material besides its small-strain constants.
struct ExtraParameter {
  std::string name, unit, meaning;        // unit: empty if dimensionless
  double fallback = 0, min = 0, max = 0;  // default value and accepted range
};

// Base of the materials whose parameters are mu and lambda, by default those of Lame.
struct LameParameters {
  template <class T>
  struct Params {
    T mu, lambda;  // [Pa]
  };

  template <class T>
  static Params<T> params(const MaterialParametersOver<T>& m) {
    return {m.lame.mu, m.lame.lambda};
  }
};

// Description of a material.
struct MaterialInfo {
  std::string name;              // "neo_hookean"
  std::string formula;           // energy density as one line of plain text
  std::vector<std::string> tex;  // energy density, definitions of its symbols and its domain in TeX, for pages
  std::string remarks;           // limits and source; one or two sentences
  std::vector<ExtraParameter> extra = {};  // in the order of MaterialParameters::extra
  bool barrier = false;                    // +inf for det F <= 0
  bool objective = true;                   // invariant under rotations of the body
};

const std::vector<MaterialInfo>& materials();              // all, in the order of help texts
const MaterialInfo& material_info(std::string_view name);  // throws InvalidInput for an unknown name

}  // namespace aspic
