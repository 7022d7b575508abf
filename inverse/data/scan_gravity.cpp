#include "data/scan_gravity.h"

#include "base/error.h"

namespace aspic {

Vec3d read_scan_gravity(const CaptureSettings& settings, const Value& gravity) {
  const Vec3d g = settings.unit("gravity") * gravity.vector();
  if (!(norm(g) > 0))
    throw error_at(gravity.place, "mesh_gravity = [0, 0, 0]; an unloaded mesh needs no mesh_gravity: remove the key");
  if (!settings.find("fixed"))
    throw error_at(gravity.place, "mesh_gravity needs vertices that hold the body during the scan; give fixed");
  if (const Value* grips = settings.find("grip"); grips && !grips->array().empty())
    throw error_at(grips->array().front().place,
                   "a grip and mesh_gravity exclude each other; give the unloaded mesh, or only fixed vertices");
  if (const Value* tips = settings.find("tip"))
    for (const Value& tip : tips->array())
      if (tip["contact"].text() == "bonded")
        throw error_at(tip["contact"].place,
                       "a bonded tip and mesh_gravity exclude each other; use contact = \"sliding\"");
  return g;
}

}  // namespace aspic
