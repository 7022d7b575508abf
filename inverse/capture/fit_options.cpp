#include "capture/fit_options.h"

#include <limits>

#include "base/error.h"
#include "scene/schema_table.h"

namespace aspic {
namespace {

Smoothness smoothness_named(const std::string& name) {
  if (name == "none") return Smoothness::none;
  return name == "tv" ? Smoothness::total_variation : Smoothness::h1;
}

int parts_of(const Value& parts) {
  if (!parts.is_text()) return parts.integer();
  return parts.text() == "auto" ? -1 : 0;
}

}  // namespace

const Schema& fit_options_schema() {
  static const Schema schema = [] {
    Schema s;
    s.sections.push_back({"fit", "*.toml", "Options of a fit."});
    add_keys(s, "fit",
             {{.name = "smooth",
               .accepts = kText,
               .fallback = "\"h1\"",
               .choices = {"h1", "tv", "none"},
               .meaning = "smoothness of fields: h1 smooth, tv few edges, none"},
              {.name = "prior",
               .accepts = kNumber | kText,
               .fallback = "2.0",
               .range = kPositive,
               .choices = {"none"},
               .meaning = "standard deviation of the prior of log E, or \"none\""},
              {.name = "weight",
               .accepts = kNumber | kText,
               .fallback = "\"auto\"",
               .range = kNotNegative,
               .choices = {"auto"},
               .meaning = "weight of smoothness and prior"},
              {.name = "rule",
               .accepts = kText,
               .fallback = "\"auto\"",
               .choices = weight_rule_names(),
               .meaning = "rule that chooses the weight"},
              {.name = "parts",
               .accepts = kInteger | kText,
               .fallback = "\"off\"",
               .range = {.min = 2, .max = kMostParts},
               .choices = {"off", "auto"},
               .meaning = "number of parts of constant stiffness"},
              {.name = "refine",
               .accepts = kInteger,
               .fallback = "0",
               .range = {.min = 0, .max = 4},
               .meaning = "simulates with every tet in 8^refine"},
              {.name = "leave_out",
               .accepts = kText | kNames,
               .fallback = "[]",
               .meaning = "groups of cases to predict instead of fitting"},
              {.name = "baselines",
               .accepts = kBoolean,
               .fallback = "false",
               .meaning = "predicts leave_out by simpler models as well"},
              {.name = "mesh_errors",
               .accepts = kBoolean,
               .fallback = "true",
               .meaning = "corrects the discretization error with a finer mesh"},
              {.name = "uncertainty",
               .accepts = kBoolean,
               .fallback = "true",
               .meaning = "computes standard deviations and the next poke"},
              {.name = "cross_validation",
               .accepts = kBoolean,
               .fallback = "true",
               .meaning = "predicts each group from the others"},
              {.name = "method",
               .accepts = kText,
               .fallback = "\"auto\"",
               .choices = fit_method_names(),
               .meaning = "minimization method"},
              {.name = "starts",
               .accepts = kInteger,
               .fallback = "1",
               .range = {.min = 1, .max = 1000},
               .meaning = "number of initial guesses; the best result is kept"},
              {.name = "tolerance",
               .accepts = kNumber,
               .fallback = "1e-3",
               .range = {.min = 1e-12, .max = 0.5},
               .meaning = "decrement relative to the first one"},
              {.name = "iterations",
               .accepts = kInteger,
               .fallback = "100",
               .range = {.min = 1, .max = 100000},
               .meaning = "maximum number of iterations"}});
    return s;
  }();
  return schema;
}

bool read_fit_options(Table document, const std::string& source, FitPlan& plan) {
  check_and_complete(document, source, fit_options_schema(), "fit");
  const auto option = [&](const char* key) -> const Value& { return *document.find(key); };
  plan.regularizer.smoothness = smoothness_named(option("smooth").text());
  const Value &prior = option("prior"), &weight = option("weight");
  plan.regularizer.prior_deviation = prior.is_text() ? std::numeric_limits<double>::infinity() : prior.number();
  plan.fit.weight = weight.is_text() ? -1 : weight.number();
  plan.fit.weight_rule = option("rule").text();
  plan.fit.method = option("method").text();
  plan.fit.starts = option("starts").integer();
  plan.fit.tolerance = option("tolerance").number();
  plan.fit.max_iterations = option("iterations").integer();
  plan.parts = parts_of(option("parts"));
  plan.refine = option("refine").integer();
  plan.mesh_errors = option("mesh_errors").boolean();
  plan.uncertainty = option("uncertainty").boolean();
  plan.cross_validation = option("cross_validation").boolean();
  const Value& left_out = option("leave_out");
  plan.left_out.clear();
  if (left_out.is_text())
    plan.left_out.push_back(left_out.text());
  else
    for (const Value& group : left_out.array()) plan.left_out.push_back(group.text());
  const Value& baselines = option("baselines");
  if (baselines.boolean() && plan.left_out.empty())
    throw error_at(baselines.place,
                   "baselines = true predicts the groups of leave_out; name some, such as "
                   "leave_out = [\"poke 1\"]");
  return baselines.boolean();
}

}  // namespace aspic
