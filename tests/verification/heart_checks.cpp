// Benchmarks of passive and active heart mechanics [Land 2015].
#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "energy/fibres.h"
#include "mesh/chamber.h"
#include "mesh/generators.h"
#include "mesh/tet_nodes.h"
#include "mesh/tet_shape.h"
#include "reference/models.h"
#include "reference/statics.h"
#include "verification/families.h"

namespace aspic::verify {
namespace {

// The published solid consists of the fibre law alone and is incompressible. Here a matrix of 1 Pa carries the volume
// term, whose bulk modulus is far above the stiffness of the fibres.
struct Heart {
  double stiffness, along, across, shear;  // Guccione's constants
  double bulk;                             // [Pa]
};

MaterialParameters matrix_of(const Heart& heart) { return {{.mu = 1, .lambda = heart.bulk}, {}}; }

// direction(X): of length 1.
template <class Fibre, class Direction>
std::vector<Fibre> fibres_in(const TetMesh& mesh, const Fibre& like, const Direction& direction) {
  std::vector<Fibre> fibres(mesh.tets.size(), like);
  for (int t = 0; t < mesh.tet_count(); ++t)
    for (int q = 0; q < fibre_point_count(mesh, t); ++q) {
      const std::array<double, 4> w = fibre_point(mesh, t, q);
      Vec3d X{};
      for (int i = 0; i < 4; ++i) X = X + w[i] * mesh.rest[mesh.tets[t][i]];
      fibres[t].directions[q] = direction(X);
    }
  return fibres;
}

GuccioneFibre guccione(const Heart& heart) { return {{}, heart.stiffness, heart.along, heart.across, heart.shear}; }

ModelBuilder body_of(const TetMesh& mesh, const Heart& heart, const std::string& material) {
  ModelBuilder builder(mesh);
  builder.material(material, std::vector<MaterialParameters>(mesh.tets.size(), matrix_of(heart))).density(1000);
  return builder;
}

const std::string kMatrix = "neo_hookean_isochoric";

// Problem 1: beam 10 x 1 x 1 mm, fibres along it, pressure of 4 Pa from below.
double raised_beam(int n, const std::string& material) {
  constexpr Heart kHeart{2e3, 8, 2, 4, 1e6};
  const TetMesh mesh = raise_order(make_box({{0, 0, 0}}, {{1e-2, 1e-3, 1e-3}}, {5 * n, n, n}));
  const auto fibres = fibres_in(mesh, guccione(kHeart), [](const Vec3d&) { return Vec3d{{1, 0, 0}}; });
  const std::vector<Face> below = faces_where(mesh, [](const Vec3d& X) { return X[2] == 0; });
  Model model = body_of(mesh, kHeart, material)
                    .pin("wall", [](const Vec3d& X) { return X[0] == 0; })
                    .load(make_fibres({"fibre", mesh}, fibres))
                    .pressure("pressure", below, [](double t) { return 4 * std::min(t, 1.0); })
                    .build();
  const Simulation simulation = equilibrium(std::move(model), 2, "beam of the heart benchmark", 1e-8);
  const int end = vertices_where(mesh, [](const Vec3d& X) {
                    return X[0] > 1e-2 - 1e-9 && std::abs(X[1] - 5e-4) < 1e-9 && X[2] > 1e-3 - 1e-9;
                  }).at(0);
  return simulation.state().q[3 * end + 2];
}

void check_beam(const Subject& subject, Findings& found) {
  const std::string material = subject.replacement(kMatrix);
  const auto expect = [&](int n, double tolerance) {
    found.expect("z of the end, " + std::to_string(n) + " cells across",
                 {1e3 * raised_beam(n, material), 4.167, tolerance}, "the mesh, and the bulk modulus of 1 MPa", "mm");
  };
  expect(2, 0.021);
  if (!subject.quick) expect(4, 0.021);
}

constexpr Chamber kVentricle{7e-3, 17e-3, 10e-3, 20e-3, 5e-3};

// The depth in the wall and the meridian of a point.
struct WallPlace {
  double depth, angle;  // 0 inside to 1 outside; from the tip
};

WallPlace place_in_wall(const Vec3d& X) {
  const Chamber& c = kVentricle;
  const double r = std::hypot(X[0], X[1]);
  const auto axes = [&](double s) {
    return std::array{c.inner_radius + s * (c.outer_radius - c.inner_radius),
                      c.inner_length + s * (c.outer_length - c.inner_length)};
  };
  double low = -0.5, high = 1.5;
  for (int i = 0; i < 60; ++i) {
    const double s = 0.5 * (low + high), a = r / axes(s)[0], b = X[2] / axes(s)[1];
    (a * a + b * b > 1 ? low : high) = s;
  }
  const auto [a, b] = axes(low);
  return {low, std::atan2(r / a, -X[2] / b)};
}

// From 90 degrees to the circumference inside to -90 degrees outside, tangential to the ellipsoid at that depth.
Vec3d helix(const Vec3d& X) {
  const WallPlace at = place_in_wall(X);
  const Chamber& c = kVentricle;
  const double a = c.inner_radius + at.depth * (c.outer_radius - c.inner_radius),
               b = c.inner_length + at.depth * (c.outer_length - c.inner_length);
  const double out = a * std::cos(at.angle), up = b * std::sin(at.angle), length = std::hypot(out, up);
  const double r = std::hypot(X[0], X[1]), x = X[0] / r, y = X[1] / r;
  const double angle = std::numbers::pi * (0.5 - at.depth), along = std::sin(angle), around = std::cos(angle);
  return {{along * out / length * x - around * y, along * out / length * y + around * x, along * up / length}};
}

struct Tips {
  double inner, outer;  // z of the tips [mm]
};

struct Beat {
  Heart heart;
  double pressure, tension;  // [Pa]
  int steps;
};

Tips tips(const ChamberCells& cells, const Beat& beat, const std::string& material) {
  TetMesh mesh = make_chamber(kVentricle, cells);
  std::vector<char> is_inner(mesh.rest.size(), 0);
  for (size_t v = 0; v < mesh.rest.size(); v += cells.layers + 1) is_inner[v] = 1;
  mesh = raise_order(std::move(mesh));
  std::vector<Face> inside = boundary_faces(mesh, 0, mesh.tet_count());
  std::erase_if(inside, [&](const Face& face) {
    return !std::all_of(face.corners.begin(), face.corners.end(), [&](int v) { return is_inner[v] != 0; });
  });
  const auto is_base = [](const Vec3d& X) { return X[2] > kVentricle.base - 1e-9; };
  ModelBuilder builder = body_of(mesh, beat.heart, material);
  builder.pin("base", is_base);
  if (cells.quarters < 4) {
    builder.pin("y", [&](const Vec3d& X) { return std::abs(X[1]) < 1e-9 && !is_base(X); }, {}, {{{0, 1, 0}}});
    builder.pin("x", [&](const Vec3d& X) { return std::abs(X[0]) < 1e-9 && !is_base(X); }, {}, {{{1, 0, 0}}});
  }
  builder.load(make_fibres({"fibre", mesh}, fibres_in(mesh, guccione(beat.heart), helix)));
  builder.pressure("pressure", inside, [p = beat.pressure](double t) { return p * std::min(t, 1.0); });
  if (beat.tension > 0) {
    const auto active = fibres_in(mesh, TensionFibre{{}, beat.tension}, helix);
    builder.load(make_muscle({"muscle", mesh}, active, [](double t) { return std::min(t, 1.0); }));
  }
  const Simulation simulation = equilibrium(builder.build(), beat.steps, "chamber of the heart benchmark", 1e-7);
  const std::vector<double>& q = simulation.state().q;
  return {1e3 * q[2], 1e3 * q[3 * cells.layers + 2]};
}

struct Tolerance {
  double inner, outer;  // relative
  std::string reason;
};

void expect_tips(Findings& found, const ChamberCells& cells, const Tips& z, const Tips& reference,
                 const Tolerance& tolerance) {
  const std::string mesh = ", " + std::to_string(cells.rings) + " rings, " + std::to_string(cells.layers) + " layers";
  found.expect("z of the inner tip" + mesh, {z.inner, reference.inner, tolerance.inner * std::abs(reference.inner)},
               tolerance.reason, "mm");
  found.expect("z of the outer tip" + mesh, {z.outer, reference.outer, tolerance.outer * std::abs(reference.outer)},
               tolerance.reason, "mm");
}

void check_inflation(const Subject& subject, Findings& found) {
  const Beat beat{{1e4 * subject.stiffness, 1, 1, 1, 1e6}, 1e4, 0, 10};
  constexpr Tips kReference{-26.60, -28.27};
  const auto expect = [&](const ChamberCells& cells, double tolerance) {
    expect_tips(found, cells, tips(cells, beat, subject.replacement(kMatrix)), kReference,
                {tolerance, tolerance, "straight edges"});
  };
  expect({.rings = 8, .layers = 2, .quarters = 1}, 0.005);
  if (subject.quick) return;
  expect({.rings = 12, .layers = 3, .quarters = 1}, 0.005);
}

// The outer tip converges slowly, because fibres have no common direction at the axis.
void check_contraction(const Subject& subject, Findings& found) {
  const Beat beat{{2e3 * subject.stiffness, 8, 2, 4, 1e7}, 1.5e4, 6e4, 20};
  constexpr Tips kReference{-12.37, -15.46};
  const auto tips_of = [&](const ChamberCells& cells) { return tips(cells, beat, subject.replacement(kMatrix)); };
  const auto cells = [](int rings) { return ChamberCells{rings, rings / 2, 4, 1.4}; };
  const Tips coarse = tips_of(cells(4));
  expect_tips(found, cells(4), coarse, {-12.914, -17.432}, {2e-3, 2e-3, "measured before on this mesh"});
  if (subject.quick) return;
  const Tips middle = tips_of(cells(6)), fine = tips_of(cells(8));
  expect_tips(found, cells(6), middle, kReference, {0.02, 0.05, "coarse"});
  expect_tips(found, cells(8), fine, kReference, {0.01, 0.025, "no common direction of the fibres at the tip"});
  const double before = std::abs(middle.outer - kReference.outer), after = std::abs(fine.outer - kReference.outer);
  found.expect("z of the outer tip: order of the error, last two meshes",
               {std::log(before / after) / std::log(8.0 / 6), 2, 0.5}, "straight edges have order 2");
}

}  // namespace

void add_heart_checks(std::vector<Check>& checks) {
  const std::string axisymmetric =
      "Axisymmetric biquadratic elements with twist and linear discontinuous pressures, which share nothing with the "
      "tets";
  checks.push_back(
      {"tissue",
       "heart_beam",
       "Passive heart muscle: a beam under pressure",
       "Problem 1 of the source: Guccione's law, C = 2 kPa, bf = 8, bt = 2, bfs = 4, a follower pressure of "
       "4 Pa on the lower side of a clamped beam 10 x 1 x 1 mm. Quadratic tets.",
       "Quadratic tets of another program; the programs of the source agree within 1 %",
       check_beam,
       {"Land2015", "Guccione1991"}});
  checks.push_back(
      {"tissue",
       "heart_inflation",
       "Passive heart muscle: inflation of a chamber",
       "Problem 2 of the source: a truncated ellipsoid, Guccione's law with C = 10 kPa and equal exponents "
       "of 1, a pressure of 10 kPa inside, its base fixed. A quarter with quadratic tets.",
       axisymmetric,
       check_inflation,
       {"Land2015", "Guccione1991"}});
  checks.push_back(
      {"tissue",
       "heart_contraction",
       "Active heart muscle: contraction of a chamber",
       "Problem 3 of the source: the same ellipsoid with fibres at 90 to -90 degrees, C = 2 kPa, bf = 8, bt "
       "= 2, bfs = 4, a pressure of 15 kPa and an active tension of 60 kPa. Quadratic tets.",
       axisymmetric,
       check_contraction,
       {"Land2015", "Guccione1991"}});
}

}  // namespace aspic::verify
