#include "verification/check.h"
#include "verification/families.h"

namespace aspic::verify {

const std::vector<Check>& checks() {
  static const std::vector<Check> all = [] {
    std::vector<Check> list;
    add_material_checks(list);
    add_derivative_checks(list);
    add_point_checks(list);
    add_invariant_checks(list);
    add_momentum_checks(list);
    add_patch_checks(list);
    add_integrator_checks(list);
    add_order_checks(list);
    add_bending_checks(list);
    add_shell_checks(list);
    add_rod_checks(list);
    add_cook_checks(list);
    add_mesh_error_checks(list);
    add_sheet_checks(list);
    add_pressure_checks(list);
    add_solid_checks(list);
    add_volume_checks(list);
    add_viscoelastic_checks(list);
    add_heart_checks(list);
    add_tissue_checks(list);
    add_cylinder_checks(list);
    add_vibration_checks(list);
    add_column_checks(list);
    add_contact_sliding_checks(list);
    add_contact_static_checks(list);
    add_contact_start_checks(list);
    add_contact_motion_checks(list);
    add_contact_limit_checks(list);
    return list;
  }();
  return all;
}

}  // namespace aspic::verify
