// The motion of a scene as a function of its parameters, and the scene with fitted parameters.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "model/motion_parameters.h"
#include "scene/value.h"

namespace aspic {

struct MotionScene {
  std::string name;
  std::vector<std::string> notes;
  MotionModel model;
  TrajectoryOptions options;  // time step and linear solver of the scene
  Value body;                 // its table in the scene
};

// `names`: the parameters to fit. Throws InvalidInput with the remedy for a scene whose motion has no gradient.
MotionScene load_motion_scene(const std::filesystem::path& path, const std::vector<std::string>& overrides,
                              const std::vector<std::string>& names);

// Where fitted.toml and its inputs are written, and what from.
struct FittedScene {
  std::filesystem::path source, folder;
  std::vector<std::string> overrides, names;  // as for load_motion_scene()
  const Value& body;                          // body of the scene
};

// Writes the scene with the parameters p. Throws InvalidInput.
void write_fitted_scene(const FittedScene& scene, const MotionParameters& parameters, std::span<const double> p);

}  // namespace aspic
