#include "aspic/formulas.h"

#include <map>

namespace aspic::cli {

std::vector<std::string> formulas_of(const std::string& key) {
  static const std::map<std::string, std::vector<std::string>> formulas = {
#ifdef ASPIC_FORMULAS
#include ASPIC_FORMULAS
#endif
  };
  const auto found = formulas.find(key);
  return found == formulas.end() ? std::vector<std::string>{} : found->second;
}

}  // namespace aspic::cli
