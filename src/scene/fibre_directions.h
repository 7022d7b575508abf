// Directions of fibres: formulas, files, and harmonic fields between parts of a body.
#pragma once
#include <string>
#include <vector>

#include "energy/fibres.h"
#include "scene/body_actions.h"

namespace aspic {

struct FibreSource {
  PlacedBody& body;
  Value& scene;  // a [[body.fibre]] or [[body.muscle]]
  Vec3d up;      // against gravity, of length 1
  SceneFiles& files;
  std::string stem;  // name of files in the results
};

// Returns the directions in each tet of the user. Adds files to the results. Throws InvalidInput.
std::vector<FibreDirections> fibre_directions(const FibreSource& source);

}  // namespace aspic
