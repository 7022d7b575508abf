#include "dynamics/contact.h"

#include <cmath>

#include "contact/friction.h"
#include "mesh/box.h"

namespace aspic {

double default_creep(double gravity, const Model& model) {
  constexpr double kCreep = 1e-4;
  return kCreep * std::sqrt(gravity * size_of(model.mesh));
}

void add_contact(ContactMesh mesh, const ContactOptions& options, double creep, Model& model) {
  auto barrier = std::make_unique<Barrier>(std::move(mesh), options);
  model.contact = barrier.get();
  model.loads.push_back(std::move(barrier));
  if (!model.contact->laws().has_friction()) return;
  const double speed = creep > 0 ? creep : default_creep(9.81, model);
  auto friction = std::make_unique<Friction>(*model.contact, speed);
  model.friction = friction.get();
  model.damping.push_back(std::move(friction));
}

}  // namespace aspic
