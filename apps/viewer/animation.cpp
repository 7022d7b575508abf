#include "viewer/replies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/error.h"
#include "io/atomic_file.h"
#include "io/external_program.h"
#include "io/gltf.h"
#include "io/mesh_file.h"
#include "io/pc2.h"
#include "io/usd.h"
#include "io/zip.h"
#include "viewer/saved_scene.h"

namespace aspic::viewer {
namespace {

constexpr double kMaxPerSecond = 120;  // maximum number of frames per second
constexpr double kLargestFile = 36e6;  // maximum estimated size of a file
constexpr int kMaxMorphTargets = 240;  // more targets are slow in all programs that read them

struct Format {
  const char* name;
  double bytes_per_vertex;  // per frame
  int most_frames;
};
constexpr Format kFormats[] = {{"usd", 34, 3000}, {"pc2", 12, 20'000}, {"glb", 12, kMaxMorphTargets}};

struct Motion {
  std::vector<double> times;  // equidistant times [s]
  std::vector<std::vector<float>> frames;
  double per_second = 0;
};

std::vector<float> positions(const Surface& surface, std::span<const double> x) {
  std::vector<float> points;
  points.reserve(3 * surface.rest.size());
  for (int v = 0; v < surface.vertex_count(); ++v) {
    const Vec3d p = surface.position(v, x);
    for (int r = 0; r < 3; ++r) points.push_back(static_cast<float>(p[r]));
  }
  return points;
}

bool is_finite(const std::vector<float>& points) {
  return std::all_of(points.begin(), points.end(), [](float x) { return std::isfinite(x); });
}

// Samples the snapshots at an even rate by linear interpolation, until a position is not finite.
Motion motion_of(const ShownSide& shown, const Format& format) {
  const std::vector<Snapshot>& snapshots = shown.side.history().timeline().snapshots();
  const double begin = snapshots.front().state.time, duration = snapshots.back().state.time - begin;
  if (snapshots.size() < 2 || !(duration > 0)) throw InvalidInput("nothing has moved yet; play first, then export");
  const double per_frame = format.bytes_per_vertex * shown.surface.vertex_count();
  const double most = std::min<double>(format.most_frames, std::floor(kLargestFile / std::max(per_frame, 1.0)));
  if (most < 2)
    throw InvalidInput(
        fmt::format("a surface of {} vertices is too large for this; save the scene and run it with "
                    "aspic run, which writes animations of any size",
                    shown.surface.vertex_count()));
  const double longest = duration / (most - 1);
  const double every = std::max({shown.side.simulation().options().h, 1 / kMaxPerSecond, longest});
  Motion motion{.per_second = 1 / every};
  const int count = 1 + static_cast<int>(std::floor(duration / every + 1e-6));
  auto next = snapshots.begin() + 1;
  for (int k = 0; k < count; ++k) {
    const double time = begin + k * every;
    while (next + 1 != snapshots.end() && next->state.time < time) ++next;
    const State &before = (next - 1)->state, &after = next->state;
    const double s = std::clamp((time - before.time) / (after.time - before.time), 0.0, 1.0);
    std::vector<double> x(after.q.size());
    for (size_t i = 0; i < x.size(); ++i) x[i] = s == 1 ? after.q[i] : (1 - s) * before.q[i] + s * after.q[i];
    std::vector<float> points = positions(shown.surface, x);
    if (!is_finite(points)) break;
    motion.times.push_back(time);
    motion.frames.push_back(std::move(points));
  }
  return motion;
}

std::string usd_text(const std::string& name, const Surface& surface, const Motion& motion, const UsdView& view) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "motion.usda";
  const UsdMesh mesh{.name = name,
                     .triangles = surface.triangles,
                     .points = [&](int k) { return motion.frames[k]; },
                     .is_two_sided = true};
  write_usd(path, {mesh}, motion.times, motion.per_second, view);
  return read_file(path);
}

// Returns a ZIP archive of the point cache and the mesh that it moves.
std::string pc2_archive(const std::string& name, const Surface& surface, const Motion& motion) {
  const TemporaryFolder folder;
  const auto cache = folder.path() / "motion.pc2", mesh_path = folder.path() / "mesh.obj";
  Pc2File file = Pc2File::create(cache, surface.vertex_count());
  for (const std::vector<float>& frame : motion.frames) file.append(std::vector<double>(frame.begin(), frame.end()));
  file.close();
  TriMesh mesh{surface.rest, surface.triangles};
  for (int v = 0; v < mesh.vertex_count(); ++v)
    for (int r = 0; r < 3; ++r) mesh.vertices[v][r] = motion.frames[0][3 * v + r];
  write_mesh(mesh_path, mesh);
  return zipped({{name + "/" + name + ".obj", read_file(mesh_path)}, {name + "/" + name + ".pc2", read_file(cache)}});
}

// Turns the z axis to the y axis, which is up in glTF.
void turn_upright(Motion& motion, std::optional<Camera>& camera) {
  if (camera)
    for (Vec3d* v : {&camera->eye, &camera->right, &camera->up}) (*v)[1] = std::exchange((*v)[2], -(*v)[1]);
  for (std::vector<float>& frame : motion.frames)
    for (size_t i = 0; i + 2 < frame.size(); i += 3) frame[i + 1] = std::exchange(frame[i + 2], -frame[i + 1]);
}

}  // namespace

Json animation_reply(const ShownSide& shown, const std::string& format, std::optional<Camera> camera) {
  Motion motion = motion_of(shown, *std::find_if(std::begin(kFormats), std::end(kFormats),
                                                 [&](const Format& f) { return format == f.name; }));
  const std::string name = saved_name(shown.side.steered().scene);
  const UpAxis up = up_axis(shown.side.steered().scene.gravity);
  Json reply;
  if (format == "usd") {
    reply = file_reply(name + ".usda", usd_text(name, shown.surface, motion, {up, camera}));
  } else if (format == "pc2") {
    reply = file_reply(name + "_pc2.zip", pc2_archive(name, shown.surface, motion));
  } else {
    if (up == UpAxis::z) turn_upright(motion, camera);
    std::vector<double> times;
    for (const double time : motion.times) times.push_back(time - motion.times.front());
    reply =
        file_reply(name + ".glb", glb({{{name, shown.surface.triangles, motion.frames}}, std::move(times), camera}));
  }
  reply["note"] = fmt::format("{} frames, {:.3g} a second", motion.frames.size(), motion.per_second);
  return reply;
}

}  // namespace aspic::viewer
