// The families of checks; each function adds its own.
#pragma once
#include <vector>

#include "verification/check.h"

namespace aspic::verify {

void add_contact_sliding_checks(std::vector<Check>& checks);
void add_contact_static_checks(std::vector<Check>& checks);
void add_contact_start_checks(std::vector<Check>& checks);
void add_contact_motion_checks(std::vector<Check>& checks);
void add_contact_limit_checks(std::vector<Check>& checks);
void add_material_checks(std::vector<Check>& checks);
void add_derivative_checks(std::vector<Check>& checks);
void add_point_checks(std::vector<Check>& checks);
void add_invariant_checks(std::vector<Check>& checks);
void add_patch_checks(std::vector<Check>& checks);
void add_integrator_checks(std::vector<Check>& checks);
void add_momentum_checks(std::vector<Check>& checks);
void add_order_checks(std::vector<Check>& checks);
void add_cylinder_checks(std::vector<Check>& checks);
void add_vibration_checks(std::vector<Check>& checks);
void add_bending_checks(std::vector<Check>& checks);
void add_shell_checks(std::vector<Check>& checks);
void add_rod_checks(std::vector<Check>& checks);
void add_column_checks(std::vector<Check>& checks);
void add_cook_checks(std::vector<Check>& checks);
void add_pressure_checks(std::vector<Check>& checks);
void add_solid_checks(std::vector<Check>& checks);
void add_volume_checks(std::vector<Check>& checks);
void add_viscoelastic_checks(std::vector<Check>& checks);
void add_heart_checks(std::vector<Check>& checks);
void add_mesh_error_checks(std::vector<Check>& checks);
void add_sheet_checks(std::vector<Check>& checks);
void add_tissue_checks(std::vector<Check>& checks);

}  // namespace aspic::verify
