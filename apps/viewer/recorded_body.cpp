#include "viewer/recorded_body.h"

#include <map>
#include <utility>

#include "viewer/pin_set.h"

namespace aspic::viewer {
namespace {

RecordedSurface numbered(std::string name, Surface surface, const Numbering& numbering) {
  RecordedSurface recorded{.name = std::move(name), .surface = std::move(surface)};
  for (const int t : recorded.surface.tet) recorded.tet.push_back(static_cast<uint32_t>(numbering.tet.to_user(t)));
  for (int v = 0; v < recorded.surface.vertex_count(); ++v)
    recorded.vertex.push_back(recorded.surface.user_number(v, numbering));
  return recorded;
}

// Assigns one place to all vertices with the same adjacent tets.
void find_places(RecordedBody& body) {
  std::map<std::vector<int>, uint32_t> known;
  body.places.tets_start.push_back(0);
  for (RecordedSurface& recorded : body.surfaces) {
    for (int v = 0; v < recorded.surface.vertex_count(); ++v) {
      const std::span<const int> around = recorded.surface.tets_at(v);
      const auto [found, is_new] = known.try_emplace({around.begin(), around.end()}, body.places.rest.size());
      recorded.place.push_back(found->second);
      if (!is_new) continue;
      body.places.rest.push_back(recorded.surface.rest[v]);
      body.places.carrier.push_back(recorded.surface.carrier[v]);
      body.places.tets.insert(body.places.tets.end(), around.begin(), around.end());
      body.places.tets_start.push_back(static_cast<int>(body.places.tets.size()));
    }
  }
}

// Keeps the vertices of the model that carry a surface, and renumbers the carriers.
void keep_carriers(const Model& model, RecordedBody& body) {
  std::vector<int> point(model.mesh.rest.size(), -1);
  const auto for_carriers = [&](auto act) {
    for (RecordedSurface& recorded : body.surfaces)
      for (Carrier& carrier : recorded.surface.carrier)
        for (int n = 0; n < carrier.count; ++n) act(carrier.vertex[n]);
  };
  for_carriers([&](int v) { point[v] = 0; });
  for (size_t v = 0; v < point.size(); ++v) {
    if (point[v] < 0) continue;
    point[v] = static_cast<int>(body.source.size());
    body.source.push_back(static_cast<int>(v));
    body.rest.push_back(model.mesh.rest[v]);
  }
  for_carriers([&](int& v) { v = point[v]; });
}

// Adds a point for each vertex of a tube.
void add_tubes(RecordedBody& body) {
  for (RecordedSurface& recorded : body.surfaces) {
    Surface& surface = recorded.surface;
    for (int v = surface.first_of_tube(); v < surface.vertex_count(); ++v) {
      surface.carrier[v] = Carrier::of_vertex(static_cast<int>(body.rest.size()));
      body.tube.push_back(surface.tube[v - surface.first_of_tube()]);
      body.rest.push_back(surface.rest[v]);
      body.is_pinned.push_back(0);
      body.mass.push_back(0);
    }
  }
}

std::vector<double> lumped_mass(const Model& model) {
  const MassMatrix mass(model.mesh, model.density, MassKind::lumped);
  return {mass.vertex_mass().begin(), mass.vertex_mass().end()};
}

}  // namespace

RecordedBody body_with_interior(const Scene& scene) {
  const Model& model = scene.simulation.model();
  RecordedBody body;
  if (has_fine_skin(scene)) body.surfaces.push_back(numbered("skin", fine_surface(scene), model.numbering));
  body.surfaces.push_back(numbered("cage", boundary_of(model), model.numbering));
  find_places(body);
  keep_carriers(model, body);
  const PinSet pins(model);
  const std::vector<double> mass = lumped_mass(model);
  for (const int v : body.source) {
    body.is_pinned.push_back(pins.has(v));
    body.mass.push_back(mass[v]);
  }
  add_tubes(body);
  return body;
}

RecordedBody body_of_skins(const Scene& scene) {
  const Model& model = scene.simulation.model();
  Surface skins = fine_surface(scene);
  skins.is_fine = has_fine_skin(scene);
  RecordedBody body;
  body.rest = skins.rest;
  body.surfaces.push_back(numbered(skins.is_fine ? "skin" : "cage", std::move(skins), model.numbering));
  RecordedSurface& recorded = body.surfaces[0];
  const PinSet pins(model);
  const std::vector<double> mass = lumped_mass(model);
  for (int v = 0; v < recorded.surface.vertex_count(); ++v) {
    const int anchor = recorded.surface.anchor(v);
    body.source.push_back(v);
    body.is_pinned.push_back(recorded.surface.is_fine ? 0 : pins.has(anchor));
    body.mass.push_back(recorded.surface.is_fine ? 0 : mass[anchor]);
    recorded.surface.carrier[v] = Carrier::of_vertex(v);
  }
  return body;
}

}  // namespace aspic::viewer
