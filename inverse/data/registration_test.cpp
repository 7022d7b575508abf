#include "data/registration.h"

#include <gmock/gmock.h>

#include <random>

#include "base/error.h"
#include "data/rigid_motion.h"
#include "io/folder_test.h"
#include "mesh/generators.h"

namespace aspic {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

// A box without equal sides with a lump: no symmetry maps its surface onto itself.
TetMesh lumpy_box() {
  TetMesh mesh = make_box({{0, 0, 0}}, {{0.1, 0.06, 0.04}}, {10, 6, 4});
  for (Vec3d& X : mesh.rest) {
    const double r2 = squared_norm(X - Vec3d{{0.08, 0.045, 0.04}});
    X[2] += 0.012 * std::exp(-r2 / (2 * 0.012 * 0.012)) * X[2] / 0.04;
    X[1] += 0.1 * X[0] * X[1];
  }
  return mesh;
}

std::vector<Vec3d> points_on(const TetMesh& mesh, const SurfaceProjection& surface, int count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const Triangle& t = surface.triangles()[random() % surface.triangles().size()];
    double a = unit(random), b = unit(random);
    if (a + b > 1) a = 1 - a, b = 1 - b;
    points.push_back(mesh.rest[t[0]] + a * (mesh.rest[t[1]] - mesh.rest[t[0]]) +
                     b * (mesh.rest[t[2]] - mesh.rest[t[0]]));
  }
  return points;
}

AffineMap some_motion(double scale) {
  AffineMap map;
  map.A = scale * rotation({{1, 2, -0.5}}, 2.1);
  map.b = {{0.3, -0.2, 0.5}};
  return map;
}

std::vector<Vec3d> moved(const AffineMap& map, std::vector<Vec3d> points) {
  for (Vec3d& p : points) p = map(p);
  return points;
}

double error_of(const Registration& found, const AffineMap& applied, const std::vector<Vec3d>& points) {
  double largest = 0;
  for (const Vec3d& p : points) largest = std::max(largest, norm(found.to_mesh(applied(p)) - p));
  return largest;
}

TEST(Registration, RecoversRigidMotionOfScan) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  const std::vector<Vec3d> points = points_on(mesh, surface, 400, 1);
  const Registration found = register_to_surface(surface, moved(some_motion(1), points), RegistrationKind::rigid);
  EXPECT_LT(error_of(found, some_motion(1), points), 1e-7);
  EXPECT_LT(found.rms, 1e-8);
  EXPECT_THAT(found.ambiguities, IsEmpty());
}

TEST(Registration, RecoversScaleOfScan) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  const std::vector<Vec3d> points = points_on(mesh, surface, 400, 2);
  const Registration found =
      register_to_surface(surface, moved(some_motion(1000), points), RegistrationKind::similarity);
  EXPECT_NEAR(found.scale, 1e-3, 1e-9);
  EXPECT_LT(error_of(found, some_motion(1000), points), 1e-7);
}

TEST(Registration, DistanceIsThatOfNoise) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  std::vector<Vec3d> points = points_on(mesh, surface, 1000, 3);
  std::mt19937 random(4);
  std::normal_distribution<double> noise(0, 1e-4);
  for (Vec3d& p : points)
    for (double& x : p.a) x += noise(random);
  const Registration found = register_to_surface(surface, moved(some_motion(1), points), RegistrationKind::rigid);
  EXPECT_NEAR(found.rms, 1e-4, 1e-5);  // only the component along the normal remains
  EXPECT_LT(error_of(found, some_motion(1), points), 1e-4);
}

TEST(Registration, ReportsSymmetricPoses) {
  const TetMesh mesh = make_box({{0, 0, 0}}, {{0.1, 0.06, 0.04}}, {10, 6, 4});
  const SurfaceProjection surface(mesh);
  const std::vector<Vec3d> points = points_on(mesh, surface, 300, 5);
  const Registration found = register_to_surface(surface, points, RegistrationKind::rigid);
  EXPECT_LT(error_of(found, {}, points), 1e-7) << "the given pose is kept";
  ASSERT_FALSE(found.ambiguities.empty());
  EXPECT_THAT(found.ambiguities[0], HasSubstr("another pose fits as well"));
  EXPECT_THAT(found.ambiguities[0], HasSubstr("turned by 180 deg"));
}

// A slightly tapered box: a turn by 180 degrees fits almost as well as the true pose.
TEST(Registration, PrefersTheBestOfSimilarPoses) {
  TetMesh mesh = make_box({{0, 0, 0}}, {{0.1, 0.06, 0.04}}, {10, 6, 4});
  for (Vec3d& X : mesh.rest) X[1] += 0.15 * X[0] * (X[1] - 0.03), X[2] += 0.2 * X[1] * (X[2] - 0.02);
  const SurfaceProjection surface(mesh);
  std::vector<Vec3d> points = points_on(mesh, surface, 200, 6);
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0, 1e-4);
  for (Vec3d& p : points)
    for (double& x : p.a) x += noise(random);
  AffineMap turned;
  turned.A = rotation({{1, 0, 0.01}}, 3);
  const Registration found = register_to_surface(surface, moved(turned, points), RegistrationKind::rigid);
  EXPECT_LT(error_of(found, turned, points), 2e-4);
  EXPECT_FALSE(found.ambiguities.empty());
}

TEST(Registration, ReportsPointsOnALine) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  const std::vector<Vec3d> line = {{{0.01, 0.02, 0}}, {{0.05, 0.02, 0}}, {{0.09, 0.02, 0}}};
  EXPECT_THAT(register_to_surface(surface, line, RegistrationKind::rigid).ambiguities,
              ElementsAre(HasSubstr("the points lie on a line")));
  EXPECT_THAT(register_to_targets(line, line, RegistrationKind::rigid).ambiguities,
              ElementsAre(HasSubstr("the points lie on a line")));
}

TEST(Registration, ReportsPointsThatSlide) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  std::vector<Vec3d> flat;
  for (int i = 0; i < 5; ++i)
    for (int j = 0; j < 3; ++j) flat.push_back({{0.02 + 0.01 * i, 0.02 + 0.01 * j, 0}});
  const Registration found = register_to_surface(surface, flat, RegistrationKind::rigid);
  EXPECT_EQ(found.ambiguities.size(), 3u);
  EXPECT_THAT(found.ambiguities, testing::Contains(HasSubstr("slide along")));
  EXPECT_THAT(found.ambiguities, testing::Contains(HasSubstr("turn about")));
}

TEST(Registration, RefusesTwoPoints) {
  const TetMesh mesh = lumpy_box();
  const SurfaceProjection surface(mesh);
  EXPECT_THROW(register_to_surface(surface, std::vector<Vec3d>(2), RegistrationKind::rigid), InvalidInput);
  EXPECT_THROW(register_to_targets(std::vector<Vec3d>(2), std::vector<Vec3d>(2), RegistrationKind::rigid),
               InvalidInput);
}

class RegistrationFile : public FolderTest {};

TEST_F(RegistrationFile, ReadsBackTheMotion) {
  for (const double angle : {0.0, 1e-9, 1.0, 3.141592653589793}) {
    Registration r;
    r.scale = 0.001;
    r.to_mesh.A = r.scale * rotation({{0.2, -1, 0.3}}, angle);
    r.to_mesh.b = {{0.1, 0.2, -0.3}};
    r.ambiguities = {"the points \"slide\""};
    write_registration(path("registration.toml"), r);
    const AffineMap again = read_registration(path("registration.toml"));
    for (int i = 0; i < 9; ++i) EXPECT_NEAR(again.A.a[i], r.to_mesh.A.a[i], 1e-18) << angle;
    for (int i = 0; i < 3; ++i) EXPECT_EQ(again.b[i], r.to_mesh.b[i]);
  }
}

TEST_F(RegistrationFile, RefusesUnknownKeys) {
  folder.write("registration.toml", "scal = 2\n");
  EXPECT_THROW(read_registration(path("registration.toml")), InvalidInput);
}

}  // namespace
}  // namespace aspic
