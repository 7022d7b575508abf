// Constitutive models by name: their energy densities, parameters and units. Every tet has its own parameters.
#pragma once
#include "material/lame.h"
#include "material/registry.h"
