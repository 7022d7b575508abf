// Terms of the potential energy V(x), each with gradient and Hessian. Derive from Energy to add your own.
#pragma once
#include "energy/damping.h"
#include "energy/energy.h"
#include "energy/internal_variables.h"
#include "energy/linear_load.h"
#include "energy/mass.h"
#include "energy/pressure.h"
#include "energy/pressure_rim.h"
#include "energy/rayleigh_damping.h"
#include "energy/springs.h"
#include "energy/stiff_energy.h"
#include "energy/tet_elasticity.h"
