#include "verification/contact_models.h"

#include <algorithm>
#include <numeric>

#include "contact/barrier_function.h"
#include "dynamics/contact.h"
#include "mesh/self_intersection.h"
#include "mesh/surface.h"

namespace aspic::verify {

Model make_touching(const TouchingModel& given) {
  TetMesh mesh;
  std::vector<MaterialParameters> parameters;
  std::vector<double> density;
  for (const TouchingBody& body : given.bodies) {
    const int first = mesh.vertex_count();
    mesh.rest.insert(mesh.rest.end(), body.mesh.rest.begin(), body.mesh.rest.end());
    for (Tet tet : body.mesh.tets) {
      for (int& v : tet) v += first;
      mesh.tets.push_back(tet);
    }
    parameters.resize(mesh.tets.size(),
                      material_parameters(given.material, {.young = body.young, .poisson = given.poisson}));
    density.resize(mesh.tets.size(), body.density);
  }
  ModelBuilder builder(mesh);
  builder.material(given.material, parameters).density(density).gravity(given.gravity);
  Model model = builder.build();
  std::vector<int> rows(mesh.rest.size());
  std::iota(rows.begin(), rows.end(), 0);
  ContactMesh contact;
  int first_tet = 0;
  for (const TouchingBody& body : given.bodies) {
    std::vector<Triangle> surface = boundary_triangles(mesh, first_tet, body.mesh.tet_count());
    const auto is_out = [&](const Triangle& t) {
      return body.touches && !std::all_of(t.begin(), t.end(), [&](int v) { return body.touches(mesh.rest[v]); });
    };
    surface.erase(std::remove_if(surface.begin(), surface.end(), is_out), surface.end());
    contact.add(
        {.name = "body" + std::to_string(contact.parts.size()), .young = body.young, .friction = given.friction},
        mesh.rest, surface, rows);
    first_tet += body.mesh.tet_count();
  }
  if (given.has_floor) contact.add_plane({.name = "floor", .friction = given.friction}, {}, {{0, 1, 0}});
  for (const Wall& wall : given.walls) {
    ContactPart part{.name = "wall", .friction = given.friction};
    if (norm(wall.velocity) > 0)
      part.motion = [u = wall.velocity](double time, std::span<const Vec3d> start, std::span<Vec3d> x) {
        for (size_t i = 0; i < x.size(); ++i) x[i] = start[i] + time * u;
      };
    contact.add_plane(part, wall.origin, wall.normal);
  }
  add_contact(std::move(contact), given.contact, given.creep, model);
  return model;
}

std::pair<int, int> vertices_of(const TouchingModel& given, size_t body) {
  int first = 0;
  for (size_t b = 0; b < body; ++b) first += given.bodies[b].mesh.vertex_count();
  return {first, first + given.bodies[body].mesh.vertex_count()};
}

Vec3d mass_mean(const Model& model, std::span<const double> values, int first, int end) {
  const std::vector<double> w = weights(*model.mass, {{1, 0, 0}});
  Vec3d sum{};
  double mass = 0;
  for (int v = first; v < end; ++v) {
    sum = sum + w[3 * v] * point(values, v);
    mass += w[3 * v];
  }
  return (1 / mass) * sum;
}

Vec3d mass_mean(const Model& model, std::span<const double> values) {
  return mass_mean(model, values, 0, model.mesh.vertex_count());
}

Vec3d contact_force(const Simulation& simulation) {
  const std::vector<double>& q = simulation.state().q;
  std::vector<double> g(q.size());
  simulation.model().contact->add_gradient(q, {}, -1, g);
  Vec3d sum{};
  for (int v = 0; v < simulation.model().mesh.vertex_count(); ++v) sum = sum + point(g, v);
  return sum;
}

void expect_contact(const std::string& name, const Simulation& simulation, Findings& found) {
  const Barrier& contact = *simulation.model().contact;
  const std::vector<double>& q = simulation.state().q;
  TriMesh surface{contact.mesh().rest, contact.mesh().triangles};
  bool is_free = true;
  const std::vector<Vec3d> obstacles = contact.obstacle_points(simulation.obstacle_time());
  for (int p = 0; p < contact.mesh().point_count(); ++p) {
    const int row = contact.mesh().row[p];
    if (row >= 0) surface.vertices[p] = point(q, row);
    for (const ContactPlane& plane : contact.mesh().planes)
      is_free = is_free && (row < 0 || dot(plane.normal, surface.vertices[p] - obstacles[plane.point]) > 0);
  }
  const ContactSummary summary = contact.summary(q, simulation.obstacle_time());
  is_free = is_free && summary.contacts > 0 && summary.min_gap > 0 && self_intersections(surface).pairs.empty();
  found.expect(name + "contacts exist, and nothing intersects", {is_free ? 1.0 : 0.0, 1, 0}, "yes or no");
}

double gap_of_pressure(const ContactLaw& law, double p) {
  double low = 0, high = law.reach;
  for (int i = 0; i < 200; ++i) {
    const double middle = (low + high) / 2;
    (-law.stiffness * barrier(middle, law.reach).first > p ? low : high) = middle;
  }
  return high;
}

}  // namespace aspic::verify
