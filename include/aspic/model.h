// A model is what does not change in time: mesh, mass, the terms of V, pins. A state is what does.
#pragma once
#include "dynamics/model.h"
#include "dynamics/model_builder.h"
#include "dynamics/pressure_load.h"
#include "dynamics/share.h"
#include "dynamics/state.h"
#include "energy/angle_row.h"
