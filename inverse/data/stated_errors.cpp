#include "data/stated_errors.h"

#include <algorithm>

#include "base/error.h"
#include "base/formatted.h"
#include "data/histories.h"
#include "indenter/indenter_depth.h"

namespace aspic {
namespace {

struct StatedError {
  const char* key;
  ErrorKind kind;
  const char* unit;  // quantity of its unit; empty: dimensionless
  const char* needs;
};
constexpr StatedError kStated[] = {
    {"position", ErrorKind::position, "length", "an indenter or a grip"},
    {"rotation", ErrorKind::rotation, "angle", "an indenter or a grip"},
    {"backlash", ErrorKind::backlash, "length", "an indenter or a grip that is displaced (rotations have no backlash)"},
    {"tare", ErrorKind::tare, "force", "a force (torques have no tare)"},
    {"force_scale", ErrorKind::force_scale, "", "a force or a torque"},
    {"length_scale", ErrorKind::length_scale, "", "positions of markers"},
};

}  // namespace

std::vector<SystematicError> read_systematic_errors(const CaptureSettings& settings,
                                                    const std::vector<LoadCase>& cases) {
  const Value& table = settings["errors"];
  ErrorSigmas sigmas{};
  for (const StatedError& stated : kStated)
    if (const Value* sigma = table.find(stated.key))
      sigmas[static_cast<size_t>(stated.kind)] = sigma->number() * (*stated.unit ? settings.unit(stated.unit) : 1.0);
  std::vector<SystematicError> errors = systematic_errors(cases, sigmas);
  for (const StatedError& stated : kStated) {
    const Value* sigma = table.find(stated.key);
    const bool is_used =
        std::any_of(errors.begin(), errors.end(), [&](const SystematicError& e) { return e.kind == stated.kind; });
    if (sigma && !is_used)
      throw error_at(sigma->place, std::string(stated.key) + " = " + number_text(sigma->number()) +
                                       " concerns no case, because none has " + stated.needs + "; remove the key");
  }
  return errors;
}

namespace {

std::optional<double> read_layer_sigma(const Value& tip) {
  const Value &deviation = tip["stiffness_deviation"], *stiffness = tip.find("stiffness");
  const bool is_given = deviation.place.line > 0;
  if (is_given && !stiffness)
    throw error_at(deviation.place, "stiffness_deviation needs the stiffness of the tip; add stiffness, or remove it");
  if (!stiffness || deviation.is_text()) return std::nullopt;
  return deviation.number();
}

double read_friction_sigma(const CaptureSettings& settings, const Value& tip) {
  const Value &friction = tip["friction"], &deviation = tip["friction_deviation"];
  const auto refuse = [](const Value& value, const char* key, const char* why) {
    throw error_at(value.place, std::string(key) + " = " + number_text(value.number()) + ": " + why);
  };
  if (deviation.number() > 0 && !(friction.number() > 0))
    refuse(deviation, "friction_deviation", "the coefficient is 0; give the most probable friction, such as 0.3");
  if (friction.number() > kLargestFriction)
    refuse(friction, "friction",
           "no dry contact exceeds 5; a tip that does not slide is contact = \"bonded\", and 30 % is friction = 0.3");
  if (friction.number() > 0 && tip["contact"].text() == "bonded")
    refuse(friction, "friction", "a bonded tip does not slide; use contact = \"sliding\", or remove friction");
  if (friction.number() > 0 && has_histories(settings))
    refuse(friction, "friction",
           "loads that vary in time (steady = \"history\") allow no friction; remove one of both");
  return deviation.number();
}

bool has_rim(const Value& tip) { return tip["shape"].text() == "disc" && tip["contact"].text() == "sliding"; }

}  // namespace

double read_rim(const CaptureSettings& settings, const Value& tip) {
  const double radius = settings.unit("length") * tip["radius"].number();
  const Value* rim = tip.find("rim");
  if (!rim) return has_rim(tip) ? kUsualRim * radius : 0;
  const double value = settings.unit("length") * rim->number();
  if (!has_rim(tip))
    throw error_at(rim->place,
                   "rim: only sliding discs have a rim; remove the key, or use shape = \"disc\" and "
                   "contact = \"sliding\"");
  if (value > kRoundestRim * radius)
    throw error_at(rim->place, "rim = " + number_text(rim->number()) + " is more than " + three_digits(kRoundestRim) +
                                   " of the radius of the disc; correct it (radius of the arc between the flat end "
                                   "and the side), or use shape = \"sphere\"");
  return std::max(value, kSharpestRim * radius);
}

TipSigmas read_tip_sigmas(const CaptureSettings& settings, const Value& tip) {
  return {read_layer_sigma(tip), read_friction_sigma(settings, tip), has_rim(tip) && !tip.find("rim") ? kRimSigma : 0};
}

std::string errors_text(const std::vector<SystematicError>& errors) {
  std::string text;
  for (const StatedError& stated : kStated) {
    const auto first =
        std::find_if(errors.begin(), errors.end(), [&](const SystematicError& e) { return e.kind == stated.kind; });
    if (first == errors.end()) continue;
    text += (text.empty() ? "" : ", ") + std::string(stated.key) + " = " + inline_toml({first->sigma, {}});
  }
  return "{ " + text + " }";
}

}  // namespace aspic
