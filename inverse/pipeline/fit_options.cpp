#include "pipeline/fit_options.h"

#include <limits>

#include "base/error.h"
#include "pipeline/fit_run.h"
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

int branches_of(const Value& branches) {
  if (!branches.is_text()) return branches.integer();
  return branches.text() == "auto" ? 0 : -1;
}

}  // namespace

const Schema& fit_options_schema() {
  static const Schema schema = [] {
    Schema s;
    add_section(
        s, {"fit", "*.toml", "Options of a fit."},
        {key("smooth", kText, "smoothness of fields: h1 smooth, tv few edges, none", Choices{{"h1", "tv", "none"}},
             Usual{"\"h1\""}),
         key("prior", kNumber | kText, "standard deviation of the prior of log E, or \"none\"", kPositive,
             Choices{{"none"}}, Usual{"2.0"}),
         key("weight", kNumber | kText, "weight of smoothness and prior", kNotNegative, Choices{{"auto"}},
             Usual{"\"auto\""}),
         key("rule", kText, "rule that chooses the weight", Choices{weight_rule_names()}, Usual{"\"auto\""}),
         key("parts", kInteger | kText, "number of parts of constant stiffness", Range{.min = 2, .max = kMaxParts},
             Choices{{"off", "auto"}}, Usual{"\"off\""}),
         key("branches", kInteger | kText, "number of relaxation times, for data with histories",
             Range{.min = 1, .max = kMaxBranches}, Choices{{"off", "auto"}}, Usual{"\"auto\""}),
         key("refine", kInteger, "simulates with every tet in 8^refine", Range{.min = 0, .max = 4}, Usual{"0"}),
         key("leave_out", kText | kNames, "groups of cases to predict instead of fitting", Usual{"[]"}),
         key("loss", kText, "squares, or robust: outliers count less", Choices{{"squares", "robust"}},
             Usual{"\"squares\""}),
         key("mesh_errors", kBoolean, "corrects the discretization error with a finer mesh", Usual{"true"}),
         key("law_errors", kBoolean, "includes the choice of the law in standard deviations", Usual{"true"}),
         key("uncertainty", kBoolean, "computes standard deviations", Usual{"true"}),
         key("cross_validation", kBoolean, "predicts each group from the others", Usual{"true"}),
         key("method", kText, "minimization method", Choices{fit_method_names()}, Usual{"\"auto\""}),
         key("starts", kInteger, "number of initial guesses; the best result is kept", Range{.min = 1, .max = 1000},
             Usual{"1"}),
         key("tolerance", kNumber, "decrement relative to the first one", Range{.min = 1e-12, .max = 0.5},
             Usual{"1e-3"}),
         key("iterations", kInteger, "maximum number of iterations", Range{.min = 1, .max = 100000}, Usual{"100"})});
    return s;
  }();
  return schema;
}

void read_fit_options(Table document, const std::string& source, FitPlan& plan) {
  const Value *given_weight = document.find("weight"), *given_rule = document.find("rule");
  const bool is_weight_given = given_weight && given_weight->is_number();
  const bool is_rule_given = given_rule && given_rule->is_text() && given_rule->text() != "auto";
  check_and_complete(document, source, fit_options_schema(), "fit");
  const auto option = [&](const char* key) -> const Value& { return *document.find(key); };
  if (is_weight_given && is_rule_given)
    throw error_at(option("rule").place, "rule = " + toml_string(option("rule").text()) +
                                             " chooses the weight, but weight is a number; remove one of the two");
  plan.regularizer.smoothness = smoothness_named(option("smooth").text());
  const Value &prior = option("prior"), &weight = option("weight");
  plan.regularizer.prior_sigma = prior.is_text() ? std::numeric_limits<double>::infinity() : prior.number();
  plan.fit.weight = weight.is_text() ? -1 : weight.number();
  plan.fit.weight_rule = option("rule").text();
  plan.fit.method = option("method").text();
  plan.fit.starts = option("starts").integer();
  plan.fit.tolerance = option("tolerance").number();
  plan.fit.max_iterations = option("iterations").integer();
  plan.parts = parts_of(option("parts"));
  plan.branches = branches_of(option("branches"));
  plan.refine = option("refine").integer();
  plan.robust = option("loss").text() == "robust";
  plan.mesh_errors = option("mesh_errors").boolean();
  plan.law_errors = option("law_errors").boolean();
  plan.uncertainty = option("uncertainty").boolean();
  plan.cross_validation = option("cross_validation").boolean();
  const Value& left_out = option("leave_out");
  plan.left_out.clear();
  if (left_out.is_text())
    plan.left_out.push_back(left_out.text());
  else
    for (const Value& group : left_out.array()) plan.left_out.push_back(group.text());
}

}  // namespace aspic
