// The commands of the virtual bench: what the probe and the cameras read is recorded, case by case.
#include <fmt/format.h>

#include <algorithm>

#include "base/error.h"
#include "mesh/tet_shape.h"
#include "viewer/scene_json.h"
#include "viewer/session_impl.h"
#include "viewer/touch_place.h"

namespace aspic::viewer {
namespace {

constexpr int kMostMarkers = 5'000, kMostSites = 200, kMostDepths = 20;
constexpr size_t kMostCases = 1'000;

// What the body is at rest does not depend on these.
bool is_of_the_body(const std::string& override_text) {
  for (const char* other : {"solver", "time", "damping", "output"})
    if (key_of(override_text).starts_with(other)) return false;
  return true;
}

Json case_json(const LoadCase& load, double depth) {
  return {{"name", load.name},
          {"group", load.group},
          {"shape", load.tip->shape == TipShape::disc ? "disc" : "sphere"},
          {"radius", load.tip->radius},
          {"center", json_of(load.pose.center)},
          {"axis", json_of(load.pose.axis)},
          {"depth", depth},
          {"force", json_of(*load.force)},
          {"push", dot(*load.force, load.pose.axis)},
          {"deviation", load.force_deviation[0]}};
}

}  // namespace

std::string Session::Impl::body_text() const {
  std::string text = a->side.steered().path.string();
  for (const std::string& override_text : a->side.steered().overrides)
    if (is_of_the_body(override_text)) text += "\n" + override_text;
  int pinned = 0;
  uint64_t which = 0;
  for (int v = 0; v < a->side.model().mesh.vertex_count(); ++v)
    if (a->side.is_pinned(v)) ++pinned, which = 1'099'511'628'211 * (which ^ static_cast<uint64_t>(v));
  return text + fmt::format("\n{} {}", pinned, which);
}

Bench& Session::Impl::bench() {
  if (capture.bench) return *capture.bench;
  Busy busy(options);
  if (const Announce announce = busy.announce()) announce("setting up the bench: markers, and a mesh for the fit");
  capture.bench = std::make_unique<Bench>(a->side.steered().scene, capture.options);
  capture.body = body_text();
  return *capture.bench;
}

void Session::Impl::keep_bench() {
  if (!capture.bench) return;
  if (body_text() == capture.body) return show_fit();
  const bool had_cases = !capture.bench->data().experiment.cases.empty();
  capture.bench.reset();
  forget_fit();
  capture.words = had_cases ? "The body is another one now: what was recorded of the old one is gone." : "";
  tell_capture();
}

void Session::Impl::set_bench(Arguments& arguments) {
  BenchOptions wanted = capture.options;
  if (arguments.has("markers")) wanted.markers = arguments.integer("markers", 1, kMostMarkers);
  if (arguments.has("seed")) wanted.seed = static_cast<uint64_t>(arguments.integer("seed", 0, 1 << 30));
  if (arguments.has("noise")) {
    wanted.noise = arguments.number("noise");
    if (!(wanted.noise >= 0 && wanted.noise <= 1)) refuse("bench.noise", wanted.noise, "0 to 1 is expected");
  }
  if (arguments.has("same_mesh")) wanted.same_mesh = arguments.boolean("same_mesh");
  arguments.finish();
  if (wanted.same_mesh != capture.options.same_mesh) {
    if (capture.bench && !capture.bench->data().experiment.cases.empty())
      throw InvalidInput("the recorded cases are those of the other mesh; forget them first");
    capture.bench.reset();
    forget_fit();
  } else if (capture.bench) {
    capture.bench->set_options(wanted);
  }
  capture.options = wanted;
  bench();
  tell_capture();
}

void Session::Impl::record(Arguments& arguments) {
  const int depths = arguments.has("depths") ? arguments.integer("depths", 1, kMostDepths) : 1;
  arguments.finish();
  const Touch* touch = a->side.touched();
  if (!touch) throw InvalidInput("record: there is no tip; let it touch the body first");
  const TipPose& pose = a->side.wanted_pose();
  if (length(pose.center - touch->begun.center) == 0)
    throw InvalidInput("record: the tip only touches; press it in first");
  if (bench().data().experiment.cases.size() + depths > kMostCases)
    throw InvalidInput(fmt::format("at most {} cases are kept; forget some", kMostCases));
  Busy busy(options);
  if (const Announce announce = busy.announce()) announce("waiting until the body is at rest under the tip");
  try {
    bench().record(*touch, pose, depths, stop_token());
  } catch (...) {
    tell_capture();
    throw;
  }
  tell_capture();
}

void Session::Impl::poke_all(Arguments& arguments) {
  const int sites = arguments.integer("sites", 1, kMostSites), depths = arguments.integer("depths", 1, kMostDepths);
  const double depth = arguments.number("depth");
  Tip tip = tip_of(arguments, a->side.model(), boundary_of(a->side.model()));
  arguments.finish();
  if (!(depth > 0 && depth <= 10 * tip.radius))
    refuse("poke_all.depth", depth, "a positive depth, at most ten radii of the tip, is expected [m]");
  const std::vector<PokeSite> places = bench().sites(tip.radius, sites);
  if (places.empty()) throw InvalidInput("there is no free and flat place for this tip; choose a smaller radius");
  if (bench().data().experiment.cases.size() + places.size() * depths > kMostCases)
    throw InvalidInput(fmt::format("at most {} cases are kept; forget some", kMostCases));
  Busy busy(options);
  const Announce announce = busy.announce();
  int failed = 0;
  std::string why;
  for (size_t s = 0; s < places.size(); ++s) {
    if (announce) announce(fmt::format("poking site {} of {}", s + 1, places.size()));
    const Vec3d& site = a->side.model().mesh.rest[places[s].vertex];
    const Vec3d &inward = places[s].inward, center = tip.shape == TipShape::sphere ? site - tip.radius * inward : site;
    const TipPose rest{center, inward, {}};
    const Touch touch{tip, rest, rest};
    try {
      bench().record(touch, pressed(touch, depth), depths, stop_token());
    } catch (const InvalidInput& e) {
      ++failed, why = e.what();
    }
    if (stop) break;
  }
  tell_capture();
  if (failed > 0)
    throw InvalidInput(fmt::format("{} of {} pokes were not recorded whole: {}", failed, places.size(), why));
}

void Session::Impl::forget(Arguments& arguments) {
  const bool one = arguments.has("case");
  const int count = capture.bench ? static_cast<int>(capture.bench->data().experiment.cases.size()) : 0;
  const int c = one ? arguments.integer("case", 0, count - 1) : 0;
  arguments.finish();
  if (one) {
    bench().forget(c);
  } else if (capture.bench) {
    bench().forget_all();
  }
  tell_capture();
}

void Session::Impl::save_capture(Arguments& arguments) {
  const std::string folder = arguments.text("folder");
  arguments.finish();
  if (!capture.bench || capture.bench->data().experiment.cases.empty())
    throw InvalidInput("nothing is recorded yet; record a case first");
  if (std::filesystem::exists(folder)) throw InvalidInput(folder + ": exists already; choose a new folder");
  write_data_set(folder, capture.bench->data());
  save_material(folder);
}

void Session::Impl::tell_capture() {
  Json json = {{"kind", "capture"},
               {"radius", usual_radius(boundary_of(a->side.model()))},
               {"noise", capture.options.noise},
               {"seed", capture.options.seed},
               {"words", capture.words},
               {"notes", Json::array()},
               {"markers", {{"triangles", Json::array()}, {"weights", Json::array()}}},
               {"cases", Json::array()},
               {"tets", 0},
               {"same_mesh", capture.options.same_mesh},
               {"fit", fit_json()}};
  if (const Bench* measured = capture.bench.get()) {
    for (const Vec3d& X : measured->marker_rest()) {
      const SurfacePoint p = nearest_surface_point(a->surface, X);
      json["markers"]["triangles"].push_back(p.triangle);
      for (int c = 0; c < 3; ++c) json["markers"]["weights"].push_back(static_cast<float>(p.weights[c]));
    }
    const auto& cases = measured->data().experiment.cases;
    for (size_t c = 0; c < cases.size(); ++c) json["cases"].push_back(case_json(cases[c], measured->depths()[c]));
    json["tets"] = measured->data().experiment.mesh.tet_count();
    json["same_mesh"] = measured->is_same_mesh();
    json["notes"] = measured->notes();
  }
  tell(text(json));
}

}  // namespace aspic::viewer
