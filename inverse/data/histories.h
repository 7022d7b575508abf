// Loads that vary in time: groups of cases with times become histories (fit/load_history.h).
#pragma once
#include <string>
#include <vector>

#include "data/data_set.h"
#include "data/force_series.h"
#include "data/settings.h"

namespace aspic {

// Whether the settings declare cases with a time as waypoints of histories: steady = "history".
bool has_histories(const CaptureSettings& settings);

// Gives the last waypoint of each history the mean force at the end of the series. Called before unstated standard
// deviations are chosen.
void add_end_forces(const ForceSeries* series, DataSet& data);
// Moves the waypoints from the cases to histories. Their last states remain as cases unless there are others. Adds an
// error per invalid row.
void take_histories(const ForceSeries* series, ErrorList& errors, DataSet& data);

std::string fingerprint_of(const std::vector<LoadHistory>& histories);  // empty without histories

}  // namespace aspic
