// The constants of contact between two parts.
#pragma once
#include <vector>

#include "contact/contact_mesh.h"

namespace aspic {

struct ContactLaw {
  double reach = 0;      // distance at which contact begins [m]
  double stiffness = 0;  // kappa [Pa]
  double share = 0;      // of the integral over the first surface; that over the second one has the rest
  double friction = 0;   // coefficient
  double guard = 0;      // least area of a point near the guards' reach [m^2]
};

struct ContactOptions {
  double reach = 0;      // [m]; 0: a fiftieth of the mean edge of the finer surface
  double stiffness = 0;  // [Pa]; 0: a tenth of the smaller Young's modulus
};

// The laws of all pairs of parts, for points of the first part near the second one.
class ContactLaws {
 public:
  ContactLaws() = default;
  ContactLaws(const ContactMesh& mesh, const ContactOptions& options);
  const ContactLaw& operator()(int first, int second) const { return law_[first * parts_ + second]; }
  ContactLaw& operator()(int first, int second) { return law_[first * parts_ + second]; }
  double largest_reach() const;

 private:
  size_t parts_ = 0;
  std::vector<ContactLaw> law_;
};

}  // namespace aspic
