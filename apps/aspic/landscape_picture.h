// Pictures of E around an iteration of a minimization.
#pragma once
#include "aspic/plot.h"
#include "results/trace.h"

namespace aspic::cli {

// Chart of E along d with its quadratic model, the lines of sufficient decrease, and the trials. Far larger values are
// clipped.
Chart line_search_chart(const Landscape& landscape);

// Surface of E over the plane through d, with its quadratic model.
SurfacePlot slice_surface(const Landscape& landscape);

}  // namespace aspic::cli
