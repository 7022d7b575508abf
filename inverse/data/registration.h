// Registration: the motion that maps measured points onto the surface of a body, by iterative closest points
// [Besl 1992; Chen 1992].
#pragma once
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "data/surface_projection.h"
#include "scene/placement.h"

namespace aspic {

enum class RegistrationKind { rigid, similarity };  // a similarity also scales

struct Registration {
  AffineMap to_mesh;  // A = scale * rotation; b [m]
  double scale = 1;
  int points = 0;
  double rms = 0, largest = 0;           // distances of the moved points from their targets [m]
  std::vector<std::string> ambiguities;  // motions that the points do not determine, in words
};

// Finds the motion of the points that brings them closest to the surface. It keeps the given coordinates if they fit
// equally well, and lists other poses that do. Throws InvalidInput for fewer than 3 points, or if the
// scale is not determined.
Registration register_to_surface(const SurfaceProjection& surface, std::span<const Vec3d> points,
                                 RegistrationKind kind);

// Finds the motion that brings each point closest to its own target [Umeyama 1991]. Throws InvalidInput for fewer than
// 3 pairs.
Registration register_to_targets(std::span<const Vec3d> points, std::span<const Vec3d> targets, RegistrationKind kind);

// A TOML file with the keys scale, rotate and translate of a body of a scene. Throws InvalidInput.
void write_registration(const std::filesystem::path& path, const Registration& registration);
AffineMap read_registration(const std::filesystem::path& path);

std::string text_of(const Registration& registration);  // "turned by 30 deg about (0, 0, 1), moved by ..."

}  // namespace aspic
