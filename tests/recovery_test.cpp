// Bodies whose vertices are at random positions in their box, in one point or on a plane: a body that is held at one
// end finds an equilibrium from there in a single step.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "scene/scene_cases_test.h"

namespace aspic {
namespace {

const std::string kStatics = "gravity = [0, 0, 0]\n[time]\nstep = 1\nduration = 1\nintegrator = \"quasi_static\"\n";

std::string held(const std::string& shape, const std::string& model, const std::string& displacement) {
  return kStatics + "[[body]]\nname = \"b\"\n" + shape + "\nmaterial = { model = \"" + model +
         "\", poisson = 0.4 }\ndeform = { displacement = [" + displacement +
         "] }\n[[body.pin]]\nwhere = { lowest = 0.05 }\n";
}

// Numbers in [0, 1) without a pattern that a mesh could resolve.
std::string noise(int seed) {
  const std::string wave = "sin(12.9898*X+78.233*Y+37.719*Z+" + std::to_string(seed) + ")*43758.5453";
  return "(" + wave + "-floor(" + wave + "))";
}
// Held vertices keep their positions.
std::string free_vertices_by(const std::string& value) { return "\"Y < 0.05 ? 0 : " + value + "\""; }
std::string strewn(const Vec3d& low, const Vec3d& high, int seed) {
  std::string text;
  for (int k = 0; k < 3; ++k)
    text += (k > 0 ? ", " : "") + free_vertices_by(std::to_string(low[k]) + "+" + std::to_string(high[k] - low[k]) +
                                                   "*" + noise(3 * seed + k) + "-" + "XYZ"[k]);
  return text;
}

Vec3d corner(std::span<const double> q, int v) { return {{q[3 * v], q[3 * v + 1], q[3 * v + 2]}}; }

// Dihedral angle at edge a b between the faces through c and d [rad].
double dihedral(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d m = cross(b - a, c - a), n = cross(b - a, d - a), s = cross(m, n);
  return std::atan2(norm(s), dot(m, n));
}

// Largest winding number of the tets around an interior edge; 1 unless the shape is folded.
int largest_winding(const TetMesh& mesh, std::span<const double> q) {
  std::map<std::array<int, 3>, int> faces;
  std::map<std::array<int, 2>, double> angles;
  for (const Tet& tet : mesh.tets)
    for (int k = 0; k < 4; ++k) {
      std::array<int, 3> face = {tet[(k + 1) % 4], tet[(k + 2) % 4], tet[(k + 3) % 4]};
      std::sort(face.begin(), face.end());
      ++faces[face];
      for (int l = 0; l < k; ++l) {
        std::array<int, 2> others;
        int count = 0;
        for (int m = 0; m < 4; ++m)
          if (m != k && m != l) others[count++] = tet[m];
        angles[{std::min(tet[k], tet[l]), std::max(tet[k], tet[l])}] +=
            dihedral(corner(q, tet[k]), corner(q, tet[l]), corner(q, others[0]), corner(q, others[1]));
      }
    }
  for (const auto& [face, count] : faces)
    if (count == 1)
      for (const std::array<int, 2> edge :
           {std::array{face[0], face[1]}, std::array{face[0], face[2]}, std::array{face[1], face[2]}})
        angles.erase(edge);
  double largest = 0;
  for (const auto& [edge, angle] : angles) largest = std::max(largest, angle);
  return static_cast<int>(std::lround(largest / (2 * std::numbers::pi)));
}

struct Recovery {
  StepReport report;
  int winding = 0;
  bool is_at_rest() const { return std::abs(report.potential_total) < 1e-6 && report.min_det_F > 0.999; }
};

Recovery recover(const std::filesystem::path& path) {
  Scene scene = load_scene(path, {.allow_outside = true});
  Recovery found{scene.simulation.step()};
  found.winding = largest_winding(scene.simulation.model().mesh, scene.simulation.state().q);
  EXPECT_TRUE(is_success(found.report.status)) << to_string(found.report.status);
  return found;
}

TEST(Recovery, HeldBoxRecoversFromDegenerateStates) {
  const TestFolder folder;
  const std::string box = "shape = { box = { upper = [1, 0.5, 0.5], cells = [8, 4, 4] } }";
  const auto to = [](const std::string& place, int seed) { return free_vertices_by(place + "+1e-6*" + noise(seed)); };
  for (const char* model : {"stable_neo_hookean", "neo_hookean", "arap"})
    for (const std::string& start :
         {strewn({}, {{1, 0.5, 0.5}}, 1), strewn({}, {{1, 0.5, 0.5}}, 2),
          to("0.5-X", 1) + ", " + to("0.25-Y", 2) + ", " + to("0.25-Z", 3), "0, " + to("0.25-Y", 1) + ", 0"}) {
      SCOPED_TRACE(std::string(model) + ": " + start);
      const Recovery found = recover(folder.write("s.toml", held(box, model, start)));
      EXPECT_TRUE(found.is_at_rest()) << found.report.potential_total << " J";
      EXPECT_EQ(found.winding, 1);
      EXPECT_LT(found.report.iterations, 60);                         // clamping alone needs up to a few hundred,
      EXPECT_LT(found.report.trials, 1.5 * found.report.iterations);  // mostly with short steps
    }
}

// From another minimum than the rest shape no path leads out without flat tets: its tets wind twice around an edge.
TEST(Recovery, HeldBunnyRecoversOrStaysWoundAroundEdge) {
  const std::string mesh = std::string(ASPIC_SOURCE_DIR) + "/scenes/bunny.mesh";
  const TestFolder folder;
  const std::string bunny = "mesh = \"" + mesh + "\"\nscale = 0.1";
  for (const int seed : {1, 2}) {
    SCOPED_TRACE(seed);
    const std::string start = strewn({{-0.49, 0, -0.37}}, {{0.49, 0.95, 0.38}}, seed);
    const Recovery found = recover(folder.write("s.toml", held(bunny, "stable_neo_hookean", start)));
    EXPECT_LT(found.report.iterations, 150);
    EXPECT_GT(found.report.min_det_F, 0);
    EXPECT_EQ(found.is_at_rest(), found.winding == 1) << found.report.potential_total << " J";
  }
}

}  // namespace
}  // namespace aspic
