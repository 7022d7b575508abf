// The mesh of a body, any slice of which can be made without the others.
#pragma once
#include <memory>
#include <vector>

#include "mesh/tet_mesh.h"
#include "scene/scene_files.h"
#include "scene/value.h"

namespace aspic::distributed {

class SlicedBody {
 public:
  virtual ~SlicedBody() = default;
  virtual double vertex_count() const = 0;  // may exceed the range of int
  virtual double tet_count() const = 0;
  // Return slices in the user's order, before the body is placed. Throw InvalidInput if a file is damaged.
  virtual std::vector<Vec3d> vertices(int first, int count) const = 0;
  virtual std::vector<Tet> tets(int first, int count) const = 0;
  virtual bool has_regions() const = 0;
  virtual int region(int tet) const = 0;           // label; 0 without labels
  virtual std::vector<Vec3d> corners() const = 0;  // of a box; else empty
  virtual bool is_file() const = 0;
};

// Returns null for a body whose mesh can only be made as a whole.
std::unique_ptr<SlicedBody> sliced_body(const Value& body, const SceneFiles& files);

}  // namespace aspic::distributed
