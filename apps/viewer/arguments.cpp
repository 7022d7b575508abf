#include "viewer/arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/printable.h"

namespace aspic::viewer {
namespace {

constexpr int kDeepestNesting = 12;  // maximum depth of a message
constexpr size_t kMaxTexts = 200;    // maximum length of a list
constexpr size_t kLongest = 4096;    // maximum length of a text [bytes]

std::string shown(const Json& value) { return shortened(value.dump(-1, ' ', true, Json::error_handler_t::replace)); }

bool is_finite_number(const Json& value) { return value.is_number() && std::isfinite(value.get<double>()); }

}  // namespace

Json parse_json(std::string_view text, size_t most) {
  if (text.size() > most)
    throw InvalidInput(fmt::format("a message of {} bytes; at most {} are read", text.size(), most));
  bool is_deep = false;
  const auto note_depth = [&](int depth, Json::parse_event_t, Json&) {
    is_deep = is_deep || depth > kDeepestNesting;
    return !is_deep;
  };
  try {
    Json value = Json::parse(text, note_depth);
    if (is_deep) throw InvalidInput(fmt::format("a message nested deeper than {} levels", kDeepestNesting));
    return value;
  } catch (const Json::exception& e) {
    throw InvalidInput(fmt::format("not a message in JSON: {}", e.what()));
  }
}

void refuse(const std::string& key, const Json& value, const std::string& expected) {
  throw InvalidInput(fmt::format("{} = {}: {}", key, shown(value), expected));
}

Arguments::Arguments(const Json& object, std::string name) : object_(object), name_(std::move(name)) {
  if (!object.is_object()) refuse(name_, object, "an object is expected, such as {\"do\": \"play\"}");
}

void Arguments::fail(const char* key, const std::string& expected) const {
  refuse(name_ + "." + key, object_.at(key), expected);
}

const Json& Arguments::value(const char* key) {
  known_.insert(key);
  if (!has(key)) throw InvalidInput(fmt::format("{}: '{}' is missing", name_, key));
  return object_.at(key);
}

double Arguments::number(const char* key) {
  const Json& v = value(key);
  if (!is_finite_number(v)) fail(key, "a finite number is expected");
  return v.get<double>();
}

int Arguments::integer(const char* key, int lowest, int highest) {
  const Json& v = value(key);
  const bool fits = is_finite_number(v) && v.get<double>() >= lowest && v.get<double>() <= highest &&
                    v.get<double>() == std::floor(v.get<double>());
  if (!fits) fail(key, fmt::format("a whole number from {} to {} is expected", lowest, highest));
  return static_cast<int>(v.get<double>());
}

bool Arguments::boolean(const char* key) {
  const Json& v = value(key);
  if (!v.is_boolean()) fail(key, "true or false is expected");
  return v.get<bool>();
}

std::string Arguments::text(const char* key, size_t most) {
  const Json& v = value(key);
  if (!v.is_string()) fail(key, "a text is expected");
  auto text = v.get<std::string>();
  if (text.size() > most) fail(key, fmt::format("a text of at most {} bytes is expected", most));
  if (text.find('\0') != std::string::npos) fail(key, "a text without zero bytes is expected");
  return text;
}

std::string Arguments::choice(const char* key, const std::vector<std::string>& choices) {
  const Json& v = value(key);
  for (const std::string& known : choices)
    if (v == known) return known;
  const auto last = choices.end() - 1;
  fail(key, fmt::format("'{}' or '{}' is expected", fmt::join(choices.begin(), last, "', '"), *last));
}

Vec3d Arguments::vector(const char* key) {
  const Json& v = value(key);
  Vec3d x{};
  bool fits = v.is_array() && v.size() == 3;
  for (int i = 0; fits && i < 3; ++i) {
    fits = is_finite_number(v[i]);
    if (fits) x[i] = v[i].get<double>();
  }
  if (!fits) fail(key, "three finite numbers are expected");
  return x;
}

// Clamps the weights and scales their sum to 1, because a page computes them in single precision.
Vec3d Arguments::weights(const char* key) {
  Vec3d weights = vector(key);
  double sum = 0;
  for (int c = 0; c < 3; ++c) {
    if (!(weights[c] >= -0.01 && weights[c] <= 1.01)) fail(key, "three numbers from 0 to 1 are expected");
    weights[c] = std::clamp(weights[c], 0.0, 1.0);
    sum += weights[c];
  }
  if (std::abs(sum - 1) > 0.01) fail(key, "their sum must be 1");
  return (1 / sum) * weights;
}

std::vector<std::string> Arguments::texts(const char* key) {
  const Json& v = value(key);
  bool fits = v.is_array() && v.size() <= kMaxTexts;
  std::vector<std::string> list;
  for (size_t i = 0; fits && i < v.size(); ++i) {
    fits = v[i].is_string() && v[i].get_ref<const std::string&>().size() <= kLongest &&
           v[i].get_ref<const std::string&>().find('\0') == std::string::npos;
    if (fits) list.push_back(v[i].get<std::string>());
  }
  if (!fits) fail(key, fmt::format("at most {} texts of at most {} bytes are expected", kMaxTexts, kLongest));
  return list;
}

std::vector<int> Arguments::indices(const char* key, int count) {
  const Json& v = value(key);
  bool fits = v.is_array() && v.size() <= static_cast<size_t>(count);
  std::vector<int> list;
  for (size_t i = 0; fits && i < v.size(); ++i) {
    fits = v[i].is_number_integer() && v[i].get<double>() >= 0 && v[i].get<double>() < count;
    if (fits) list.push_back(v[i].get<int>());
  }
  if (!fits) fail(key, fmt::format("a list of numbers from 0 to {} is expected, each at most once", count - 1));
  return list;
}

void Arguments::finish() const {
  for (const auto& [key, unused] : object_.items())
    if (!known_.count(key))
      throw InvalidInput(fmt::format("{}: unknown member '{}'{}", name_, shortened(key, 40),
                                     suggestion(key, {known_.begin(), known_.end()})));
}

}  // namespace aspic::viewer
