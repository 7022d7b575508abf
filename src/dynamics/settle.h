#pragma once
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "dynamics/model.h"

namespace aspic {

// Returns why surfaces touch or intersect at q; nothing if they do not.
std::optional<std::string> overlap(const Model& model, const std::vector<double>& q);

// Returns the vertices that pins hold in any direction, ascending.
std::set<int> pinned_vertices(const Model& model);

// Repeatedly minimizes 1/2 (x - q)' M (x - q) + h^2 V(x), where V are the terms of the model, until x is at rest.
// `start`: positions that pins refer to.
void settle(const Model& model, const std::vector<double>& start, std::vector<double>& q);

// Calls `use` with a model that has elasticity and contact only. Restores the other terms afterwards.
void without_other_terms(Model& model, const std::function<void()>& use);

}  // namespace aspic
