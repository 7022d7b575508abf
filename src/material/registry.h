// The materials that scenes, the command line and other languages know by name.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "material/lame.h"

namespace aspic {

inline constexpr int kMaxExtraParameters = 13;

// The parameters of one tet: small-strain constants, and what only some materials have (MaterialInfo::extra).
template <class T>
struct MaterialParametersOver {
  LameOver<T> lame;
  std::array<T, kMaxExtraParameters> extra{};
};
using MaterialParameters = MaterialParametersOver<double>;

struct ExtraParameter {
  std::string name, unit, meaning;
  double fallback = 0, min = 0, max = 0;  // default value and accepted range
};

struct MaterialInfo {
  std::string name;     // "neo_hookean"
  std::string formula;  // the energy density, one line of plain text
  std::string remarks;  // basin of convergence, limits, source; one or two sentences
  std::vector<ExtraParameter> extra;
  bool barrier = false;  // +inf for det F <= 0
};

const std::vector<MaterialInfo>& materials();

const MaterialInfo& material_info(std::string_view name);  // throws InvalidInput with the nearest known name

}  // namespace aspic
