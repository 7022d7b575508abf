#include "scene/expression.h"

#include <muParser.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <numbers>

#include "base/error.h"
#include "scene/value.h"

namespace aspic {
namespace {

struct Function {
  const char* name;
  const char* meaning;  // empty: self-explanatory name
  double (*call)(double);
};
struct Function2 {
  const char* name;
  const char* meaning;
  double (*call)(double, double);
};
struct FunctionN {
  const char* name;
  const char* meaning;
  double (*call)(const double*, int);
};
struct Constant {
  const char* name;
  const char* meaning;
  double value;
};

double smallest(const double* a, int n) { return n > 0 ? *std::min_element(a, a + n) : NAN; }
double largest(const double* a, int n) { return n > 0 ? *std::max_element(a, a + n) : NAN; }
double negation(double a) { return a == 0; }

const Function kFunctions[] = {
    {"sin", "", [](double a) { return std::sin(a); }},
    {"cos", "", [](double a) { return std::cos(a); }},
    {"tan", "", [](double a) { return std::tan(a); }},
    {"asin", "", [](double a) { return std::asin(a); }},
    {"acos", "", [](double a) { return std::acos(a); }},
    {"atan", "", [](double a) { return std::atan(a); }},
    {"sinh", "", [](double a) { return std::sinh(a); }},
    {"cosh", "", [](double a) { return std::cosh(a); }},
    {"tanh", "", [](double a) { return std::tanh(a); }},
    {"exp", "", [](double a) { return std::exp(a); }},
    {"log", "natural logarithm", [](double a) { return std::log(a); }},
    {"sqrt", "", [](double a) { return std::sqrt(a); }},
    {"abs", "", [](double a) { return std::abs(a); }},
    {"sign", "-1, 0 or 1", [](double a) { return double((a > 0) - (a < 0)); }},
    {"floor", "", [](double a) { return std::floor(a); }},
    {"ceil", "", [](double a) { return std::ceil(a); }},
    {"round", "", [](double a) { return std::round(a); }},
};
const Function2 kFunctions2[] = {
    {"atan2", "angle of the point (b, a): atan2(a, b)", [](double a, double b) { return std::atan2(a, b); }},
    {"hypot", "sqrt(a^2 + b^2)", [](double a, double b) { return std::hypot(a, b); }},
};
const FunctionN kFunctionsN[] = {
    {"min", "smallest of its arguments", smallest},
    {"max", "largest of its arguments", largest},
};
const Constant kConstants[] = {
    {"pi", "3.14159...", std::numbers::pi},
    {"all", "1, so that where = \"all\" selects everything", 1.0},
};

std::string in_column(const std::string& text, size_t column, const std::string& reason) {
  return "column " + std::to_string(column) + " of \"" + shortened(text) + "\": " + reason;
}

// Rejects text that the parser accepts but formulas must not contain: assignments, strings, lists.
void check_text(const std::string& text) {
  if (text.find_first_not_of(" \t") == std::string::npos) throw InvalidInput("the expression is empty");
  if (text.size() > kMaxExpressionLength)
    throw InvalidInput(in_column(text, kMaxExpressionLength + 1,
                                 std::to_string(text.size()) + " characters; at most " +
                                     std::to_string(kMaxExpressionLength) + " are supported (use a per-element file)"));
  int depth = 0;
  for (size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    const bool allowed = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                         std::string_view("_.+-*/^()<>=!&|?:, \t").find(c) != std::string_view::npos;
    if (!allowed) throw InvalidInput(in_column(text, i + 1, std::string("unexpected character '") + c + "'"));
    if (c == '=') {
      const char before = i > 0 ? text[i - 1] : ' ', after = i + 1 < text.size() ? text[i + 1] : ' ';
      const bool compares = after == '=' || before == '=' || before == '<' || before == '>' || before == '!';
      if (!compares) throw InvalidInput(in_column(text, i + 1, "'=' is not allowed; compare with '=='"));
    }
    depth += (c == '(') - (c == ')');
    if (depth > kMaxExpressionDepth)
      throw InvalidInput(
          in_column(text, i + 1, "more than " + std::to_string(kMaxExpressionDepth) + " open parentheses"));
  }
}

std::vector<std::string> known_names(ExpressionVariables variables) {
  std::vector<std::string> names = {"x", "y", "X", "Y"};
  if (variables != ExpressionVariables::plane_position) names.insert(names.end(), {"z", "Z"});
  if (variables == ExpressionVariables::position_and_time) names.push_back("t");
  for (const NamedMeaning& f : expression_functions()) names.push_back(f.name);
  for (const NamedMeaning& c : expression_constants()) names.push_back(c.name);
  return names;
}

std::string reason_of(const mu::ParserError& e, ExpressionVariables variables) {
  switch (e.GetCode()) {
    case mu::ecUNASSIGNABLE_TOKEN:
      if (e.GetToken() == "t" && variables == ExpressionVariables::position)
        return "'t' is not allowed: this is evaluated once, at the start";
      if (e.GetToken().size() == 1)  // every other letter is near
        return "unknown name '" + e.GetToken() + "' (a point is " +
               (variables == ExpressionVariables::plane_position ? "x, y or X, Y)" : "x, y, z or X, Y, Z)");
      return "unknown name '" + e.GetToken() + "'" + suggestion(e.GetToken(), known_names(variables));
    case mu::ecUNEXPECTED_EOF:
      return "ends too early";
    case mu::ecMISSING_PARENS:
      return "a parenthesis is missing";
    case mu::ecTOO_MANY_PARAMS:
      return "too many arguments for '" + e.GetToken() + "'";
    case mu::ecTOO_FEW_PARAMS:
      return "too few arguments for '" + e.GetToken() + "'";
    case mu::ecUNEXPECTED_VAL:
    case mu::ecUNEXPECTED_VAR:
    case mu::ecUNEXPECTED_FUN:
    case mu::ecUNEXPECTED_OPERATOR:
    case mu::ecUNEXPECTED_PARENS:
    case mu::ecUNEXPECTED_ARG_SEP:
      return "unexpected '" + e.GetToken() + "'";
    default:
      return e.GetMsg();
  }
}

}  // namespace

struct Expression::Impl {
  std::string text;
  ExpressionVariables variables;
  mutable std::mutex evaluation;  // the parser evaluates in place
  mutable mu::Parser parser;
  mutable std::array<double, 4> value{};  // X Y Z t
};

Expression::Expression(const std::string& text, ExpressionVariables variables) {
  check_text(text);
  auto impl = std::make_shared<Impl>();
  impl->text = text;
  impl->variables = variables;
  mu::Parser& parser = impl->parser;
  try {
    parser.ClearFun();
    parser.ClearConst();
    for (const Function& f : kFunctions) parser.DefineFun(f.name, f.call);
    for (const Function2& f : kFunctions2) parser.DefineFun(f.name, f.call);
    for (const FunctionN& f : kFunctionsN) parser.DefineFun(f.name, f.call);
    for (const Constant& c : kConstants) parser.DefineConst(c.name, c.value);
    parser.DefineInfixOprt("!", negation);
    const char* upper[] = {"X", "Y", "Z", "t"};
    const char* lower[] = {"x", "y", "z"};
    const int space = variables == ExpressionVariables::plane_position ? 2 : 3;
    for (int i = 0; i < space; ++i) {
      parser.DefineVar(upper[i], &impl->value[i]);
      parser.DefineVar(lower[i], &impl->value[i]);
    }
    if (variables == ExpressionVariables::position_and_time) parser.DefineVar(upper[3], &impl->value[3]);
    parser.SetExpr(text);
    parser.Eval();
    if (parser.GetNumResults() != 1)
      throw InvalidInput(in_column(text, text.find(',') + 1, "one value is expected, not a list"));
  } catch (const mu::ParserError& e) {
    const size_t position = e.GetPos() >= 0 ? std::min(text.size(), static_cast<size_t>(e.GetPos())) : text.size();
    throw InvalidInput(in_column(text, position + 1, reason_of(e, variables)));
  }
  impl_ = std::move(impl);
}

double Expression::evaluate(const Vec3d& X, double t) const {
  const std::lock_guard lock(impl_->evaluation);
  impl_->value = {X[0], X[1], X[2], t};
  try {
    return impl_->parser.Eval();
  } catch (const mu::ParserError& e) {
    throw InvalidInput("\"" + shortened(impl_->text) + "\": " + e.GetMsg());
  }
}

double Expression::at(const Vec3d& X, double t) const {
  const double result = evaluate(X, t);
  if (!std::isfinite(result)) {
    const bool timed = impl_->variables == ExpressionVariables::position_and_time;
    throw InvalidInput("\"" + shortened(impl_->text) + "\" is " + number_text(result) + " at " + point_text(X) +
                       (timed ? ", t = " + number_text(t) : ""));
  }
  return result;
}

bool Expression::depends_on_time() const { return impl_->parser.GetUsedVar().count("t") > 0; }

bool Expression::depends_on_position() const {
  const auto& used = impl_->parser.GetUsedVar();
  return used.size() > used.count("t");
}

const std::string& Expression::text() const { return impl_->text; }

std::vector<NamedMeaning> expression_functions() {
  std::vector<NamedMeaning> names;
  for (const Function& f : kFunctions) names.push_back({f.name, f.meaning});
  for (const Function2& f : kFunctions2) names.push_back({f.name, f.meaning});
  for (const FunctionN& f : kFunctionsN) names.push_back({f.name, f.meaning});
  return names;
}

std::vector<NamedMeaning> expression_constants() {
  std::vector<NamedMeaning> names;
  for (const Constant& c : kConstants) names.push_back({c.name, c.meaning});
  return names;
}

}  // namespace aspic
