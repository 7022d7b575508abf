#include "viewer/bench_desk.h"

#include <fmt/format.h>

#include "base/error.h"
#include "viewer/scene_json.h"
#include "viewer/settings.h"
#include "viewer/touch_place.h"

namespace aspic::viewer {
namespace {

constexpr int kMaxMarkers = 5'000, kMaxSites = 200, kMaxDepths = 20;
constexpr size_t kMaxCases = 1'000;

// Returns whether a setting changes the body at rest.
bool is_of_the_body(const std::string& override_text) {
  for (const char* other : {"solver", "time", "damping", "output"})
    if (key_of(override_text).starts_with(other)) return false;
  return true;
}

Json case_json(const LoadCase& load, double depth) {
  return {{"name", load.name},
          {"group", load.group},
          {"shape", load.indenter->shape == IndenterShape::disc ? "disc" : "sphere"},
          {"radius", load.indenter->radius},
          {"center", json_of(load.pose.center)},
          {"axis", json_of(load.pose.axis)},
          {"depth", depth},
          {"force", json_of(*load.force)},
          {"push", dot(*load.force, load.pose.axis)},
          {"deviation", load.force_sigma[0]}};
}

// Identifies the body at rest: scene, settings and pins.
std::string body_text(const Side& side) {
  std::string text = side.steered().path.string();
  for (const std::string& override_text : side.steered().overrides)
    if (is_of_the_body(override_text)) text += "\n" + override_text;
  int pinned = 0;
  uint64_t which = 0;
  for (int v = 0; v < side.model().mesh.vertex_count(); ++v)
    if (side.pins().has(v)) ++pinned, which = 1'099'511'628'211 * (which ^ static_cast<uint64_t>(v));
  return text + fmt::format("\n{} {}", pinned, which);
}

FirstContact touch_of(const Indenter& indenter, const Vec3d& site, const Vec3d& inward) {
  const IndenterPose rest{indenter.shape == IndenterShape::sphere ? site - indenter.radius * inward : site, inward, {}};
  return {indenter, rest, rest};
}

}  // namespace

void BenchDesk::add_to(Commands& commands) {
  const auto add = [&](const char* name, auto carry_out) {
    commands[name] = {[this, carry_out](Arguments& arguments) { (this->*carry_out)(arguments); }, false};
  };
  add("bench", &BenchDesk::set_bench);
  add("record", &BenchDesk::record);
  add("poke_all", &BenchDesk::poke_all);
  add("forget", &BenchDesk::forget);
  add("save_capture", &BenchDesk::save_capture);
  commands["fit"] = {plain([this] { fit_.start(bench_.get()), send(); }), false};
  commands["stop_fit"] = {plain([this] { fit_.stop(), send(); }), false};
  commands["simulate_fit"] = {plain([this] { fit_.simulate(playback_); })};
}

Bench& BenchDesk::bench() {
  if (bench_) return *bench_;
  Busy busy(options_);
  busy("setting up the markers and the mesh of the fit");
  bench_ = std::make_unique<Bench>(stage_.a().side.steered().scene, wanted_);
  body_ = body_text(stage_.a().side);
  return *bench_;
}

void BenchDesk::check_body() {
  if (!bench_) return;
  if (body_text(stage_.a().side) == body_) return fit_.show();
  const bool had_cases = case_count() > 0;
  bench_.reset();
  fit_.drop(had_cases ? "The body has changed. The cases of the old one are deleted." : "");
  send();
}

void BenchDesk::add(const FitNews& news) {
  if (fit_.add(news)) send();
}

void BenchDesk::require_room(size_t cases) {
  if (bench().data().experiment.cases.size() + cases > kMaxCases)
    throw InvalidInput(fmt::format("a data set has at most {} cases; forget some", kMaxCases));
}

// ---------------------------------------------------------------- commands

void BenchDesk::set_bench(Arguments& arguments) {
  BenchOptions wanted = wanted_;
  if (arguments.has("markers")) wanted.markers = arguments.integer("markers", 1, kMaxMarkers);
  if (arguments.has("seed")) wanted.seed = static_cast<uint64_t>(arguments.integer("seed", 0, 1 << 30));
  if (arguments.has("noise")) {
    wanted.noise = arguments.number("noise");
    if (!(wanted.noise >= 0 && wanted.noise <= 1)) refuse("bench.noise", wanted.noise, "0 to 1 is expected");
  }
  if (arguments.has("same_mesh")) wanted.same_mesh = arguments.boolean("same_mesh");
  arguments.finish();
  if (wanted.same_mesh != wanted_.same_mesh) {
    if (case_count() > 0) throw InvalidInput("the recorded cases belong to the other mesh; forget them first");
    bench_.reset();
    fit_.drop();
  } else if (bench_) {
    bench_->set_options(wanted);
  }
  wanted_ = wanted;
  bench();
  send();
}

void BenchDesk::record(Arguments& arguments) {
  const int depths = arguments.has("depths") ? arguments.integer("depths", 1, kMaxDepths) : 1;
  arguments.finish();
  const IndenterTool& indenter = stage_.a().side.tools().indenter;
  const FirstContact* touch = indenter.touch();
  if (!touch) throw InvalidInput("record: there is no indenter; place it on the body first");
  if (norm(indenter.wanted().center - touch->begun.center) == 0)
    throw InvalidInput("record: the indentation depth is 0; press the indenter in first");
  require_room(depths);
  Busy busy(options_);
  busy("computing the equilibrium under the indenter");
  try {
    bench().record(*touch, indenter.wanted(), depths, playback_.stop_token());
  } catch (...) {
    send();
    throw;
  }
  send();
}

void BenchDesk::poke_all(Arguments& arguments) {
  const Model& model = stage_.a().side.model();
  const int sites = arguments.integer("sites", 1, kMaxSites), depths = arguments.integer("depths", 1, kMaxDepths);
  const double depth = arguments.number("depth");
  const Indenter indenter = indenter_of(arguments, model, boundary_of(model));
  arguments.finish();
  if (!(depth > 0 && depth <= 10 * indenter.radius))
    refuse("poke_all.depth", depth, "a positive depth, at most ten radii of the indenter, is expected [m]");
  const std::vector<IndentationSite> places = bench().sites(indenter.radius, sites);
  if (places.empty()) throw InvalidInput("there is no free and flat place for this indenter; choose a smaller radius");
  require_room(places.size() * depths);
  Busy busy(options_);
  const StopToken stop = playback_.stop_token();
  int failed = 0;
  std::string why;
  for (size_t s = 0; s < places.size(); ++s) {
    busy(fmt::format("poking site {} of {}", s + 1, places.size()));
    const FirstContact touch = touch_of(indenter, model.mesh.rest[places[s].vertex], places[s].inward);
    try {
      bench().record(touch, pressed(touch, depth), depths, stop);
    } catch (const InvalidInput& e) {
      ++failed, why = e.what();
    }
    if (stop.stopped()) break;
  }
  send();
  if (failed > 0) throw InvalidInput(fmt::format("{} of {} pokes are incomplete: {}", failed, places.size(), why));
}

void BenchDesk::forget(Arguments& arguments) {
  const bool one = arguments.has("case");
  const int c = one ? arguments.integer("case", 0, case_count() - 1) : 0;
  arguments.finish();
  if (one) {
    bench().forget(c);
  } else if (bench_) {
    bench_->forget_all();
  }
  send();
}

void BenchDesk::save_capture(Arguments& arguments) {
  const std::string folder = arguments.text("folder");
  arguments.finish();
  if (case_count() == 0) throw InvalidInput("no case is recorded yet; record one first");
  if (std::filesystem::exists(folder)) throw InvalidInput(folder + ": exists already; choose a new folder");
  write_data_set(folder, bench_->data());
  fit_.save_material(folder);
}

void BenchDesk::send() const {
  Json json = {{"kind", "capture"},
               {"radius", default_radius(boundary_of(stage_.a().side.model()))},
               {"noise", wanted_.noise},
               {"seed", wanted_.seed},
               {"words", fit_.summary()},
               {"notes", Json::array()},
               {"markers", {{"triangles", Json::array()}, {"weights", Json::array()}}},
               {"cases", Json::array()},
               {"tets", 0},
               {"same_mesh", wanted_.same_mesh},
               {"fit", fit_.json()}};
  if (bench_) {
    for (const Vec3d& X : bench_->marker_rest()) {
      const SurfacePoint p = nearest_surface_point(stage_.a().surface, X);
      json["markers"]["triangles"].push_back(p.triangle);
      for (int c = 0; c < 3; ++c) json["markers"]["weights"].push_back(static_cast<float>(p.weights[c]));
    }
    const auto& cases = bench_->data().experiment.cases;
    for (size_t c = 0; c < cases.size(); ++c) json["cases"].push_back(case_json(cases[c], bench_->depths()[c]));
    json["tets"] = bench_->data().experiment.mesh.tet_count();
    json["same_mesh"] = bench_->is_same_mesh();
    json["notes"] = bench_->notes();
  }
  stage_.send(text(json));
}

}  // namespace aspic::viewer
