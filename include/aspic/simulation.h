// Simulation advances a model in time, one minimization per step. IncrementalPotential is the function E that a step
// minimizes, for loops of one's own.
#pragma once
#include "contact/contact_cost.h"
#include "dynamics/force_scales.h"
#include "dynamics/incremental_potential.h"
#include "dynamics/initial_guess.h"
#include "dynamics/integrator_facts.h"
#include "dynamics/internal_terms.h"
#include "dynamics/mesh_error.h"
#include "dynamics/pins.h"
#include "dynamics/simulation.h"
#include "dynamics/stable_step.h"
#include "dynamics/step_problem.h"
#include "dynamics/step_report.h"
#include "dynamics/step_terms.h"
#include "dynamics/term_rows.h"
