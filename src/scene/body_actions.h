// Pins, springs, loads and damping of a scene.
#pragma once
#include <memory>
#include <string>
#include <vector>

#include "dynamics/model.h"
#include "scene/painted_fields.h"
#include "scene/scene_files.h"
#include "scene/selection.h"
#include "scene/value.h"

namespace aspic {

// A body in the user's numbering, and its location in the model.
struct PlacedBody {
  Value& scene;  // the table of the body
  TetMesh mesh;  // the placed rest shape with its own indices
  std::vector<Vec3d> start;
  int first_vertex = 0, first_tet = 0;  // offsets in the model
  int first_triangle = 0;               // in TetMesh::sheet of the model
  int first_segment = 0;                // in TetMesh::rods of the model
  Numbering numbering = {};             // numbering of the body alone
  std::shared_ptr<PaintedFields> painted = {};
  // If the model has a part of the body: the whole body, and the vertices of the model.
  const WholeBody* whole = nullptr;
  std::vector<int> part_vertices = {};
  MeshGroups groups = {};

  std::string name() const { return scene["name"].text(); }
  int model_vertex(int own) const {
    return whole ? part_vertices[own] : first_vertex + numbering.vertex.from_user(own);
  }
  int user_vertex(int own) const { return whole ? whole->number_of_vertex(own) : own; }  // for messages
};

// For a selection of an action. up: against gravity, of length 1.
SelectionScope selection_scope(const PlacedBody& body, Value& where, const Vec3d& up);

struct SceneActions {
  std::vector<PlacedBody>& bodies;
  Vec3d gravity;    // [m/s^2]
  double duration;  // of the run [s]
  MassKind mass;
  SceneFiles& files;
  std::vector<std::string>& notes;  // receives notes for the user
  std::int64_t memory;              // maximum memory [bytes]
};

// Adds pins to a model that has its mesh. Throws InvalidInput.
void add_pins(const SceneActions& actions, Model& model);
// Adds loads and damping to a model that also has its mass and elasticity. Throws InvalidInput.
void add_loads_and_damping(const SceneActions& actions, Model& model);

}  // namespace aspic
