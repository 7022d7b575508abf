// Default reach of pairs of parts, bounded by what the user modeled: gaps at the start, and thin parts.
#pragma once
#include <array>
#include <set>
#include <span>
#include <string>

#include "contact/contact_laws.h"

namespace aspic {

// Gaps up to this fraction of the mean edge of the finer surface count as touching.
inline constexpr double kTouching = 1e-5;

// Returns the reach of surfaces that touch at the start [m]: a fiftieth of that of others, because surfaces in contact
// stay apart by up to the reach.
double touching_reach(const ContactLaw& law);

// Reduces the reach of each pair in `laws` to a fifth of its gap at the start, so that no contact force exists at the
// start and clearances survive, and to a tenth of the thickness of its parts. Pairs that touch at the start get
// touching_reach(). `start`: positions of all points [m].
// Gaps of the pairs in `overlapping` (ascending part numbers) are ignored. Throws std::length_error if there are too
// many close features for the memory.
void bound_reaches(const ContactMesh& mesh, std::span<const Vec3d> start,
                   const std::set<std::array<int, 2>>& overlapping, ContactLaws& laws);

// Returns the thickness that all but a twentieth of the area of a closed surface exceeds, if it is below `limit`;
// otherwise infinity. The thickness at a vertex is its distance to the opposite side [m].
double least_thickness(const ContactMesh& mesh, int part, double limit);

// Returns the distance that points of a sheet of this thickness keep from other places of the sheet [m]: the thickness,
// but at most .4 times the least distance at rest of features that are not adjacent.
double allowed_self_offset(const ContactMesh& mesh, int part, double thickness);

// Returns why a pair has its reach, such as "a fifth of their gap at the start, 0.005 m".
std::string reason_of(const ContactLaw& law);

}  // namespace aspic
