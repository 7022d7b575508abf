// Minimization of any smooth function: choose a direction, choose how far, repeat until converged. Derive from
// Objective to minimize a function of your own, and from SearchDirection to choose directions in your own way.
#pragma once
#include "optimize/line_search.h"
#include "optimize/minimize.h"
#include "optimize/objective.h"
#include "optimize/planar_function.h"
#include "optimize/search_direction.h"
#include "optimize/solver.h"
#include "optimize/test_functions.h"
#include "optimize/work.h"
