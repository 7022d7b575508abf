// E around an iteration of a minimization, as pictures.
#pragma once
#include "aspic/plot.h"
#include "scene/trace.h"

namespace aspic::cli {

// E along d with its quadratic model, the lines of sufficient decrease, and the trials; what rises far above is cut
// off.
Chart line_search_chart(const Landscape& landscape);

// E over the plane through d, and its quadratic model.
SurfacePlot slice_surface(const Landscape& landscape);

}  // namespace aspic::cli
