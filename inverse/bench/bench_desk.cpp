#include "bench/bench_desk.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "bench/bench.h"
#include "bench/indenter_place.h"
#include "data/synthesis.h"
#include "io/atomic_file.h"
#include "model/limits.h"
#include "viewer/playback.h"
#include "viewer/saved_scene.h"
#include "viewer/scene_json.h"
#include "viewer/settings.h"

namespace aspic::bench {
namespace {

namespace fs = std::filesystem;
using viewer::ShownSide, viewer::Side, viewer::Tools, viewer::refuse;

// Kinetic energy relative to the work of the indenter: the force is within 1 %, its root.
constexpr double kAtRest = 1e-4;
constexpr size_t kMaxReadings = 200;  // chosen
// The law is that of the body. Fits of held-out readings would take several times as long.
constexpr std::string_view kFitOptions = "law_errors = false\ncross_validation = false\n";

IndenterTool& tool_of(Tools& tools) { return static_cast<IndenterTool&>(tools.further); }
const IndenterTool& tool_of(const Side& side) { return static_cast<const IndenterTool&>(side.tool()); }

double positive(Arguments& arguments, const char* key, double most) {
  const double value = arguments.number(key);
  if (!(value > 0 && value <= most))
    refuse(key, value, fmt::format("a positive number, at most {:g}, is expected", most));
  return value;
}

// With defaults for missing members.
Indenter indenter_of(Arguments& touch, const Model& model, const Surface& cage) {
  Indenter indenter{.radius = default_radius(cage)};
  if (touch.has("shape") && touch.choice("shape", {"sphere", "disc"}) == "disc") indenter.shape = IndenterShape::disc;
  if (touch.has("contact") && touch.choice("contact", {"bonded", "sliding"}) == "sliding")
    indenter.contact = IndenterContact::sliding;
  if (touch.has("radius")) indenter.radius = positive(touch, "radius", kTooFar * size_of(cage));
  indenter.stiffness =
      touch.has("stiffness") ? positive(touch, "stiffness", 1e20) : default_layer(model, indenter.radius);
  return indenter;
}

// Returns whether a setting changes the body at rest.
bool is_of_the_body(const std::string& override_text) {
  for (const char* other : {"solver", "time", "damping", "output"})
    if (viewer::key_of(override_text).starts_with(other)) return false;
  return true;
}

// Identifies the body at rest: scene, settings and pins.
std::string body_text(const Side& side) {
  std::string text = side.steered().path.string();
  for (const std::string& override_text : side.steered().overrides)
    if (is_of_the_body(override_text)) text += "\n" + override_text;
  for (int v = 0; v < side.model().mesh.vertex_count(); ++v)
    if (side.pins().has(v)) text += fmt::format(" {}", v);
  return text;
}

// A data set has the indenter and gravity as its only loads.
void require_measurable(const Side& side) {
  const Model& model = side.model();
  for (const auto& load : model.loads)
    if (load->name() != "gravity" && load->name() != "probe" && load->name() != "mouse")
      throw InvalidInput(
          fmt::format("keep: the scene has the load '{}', which a data set cannot have; remove it", load->name()));
  if (model.contact) throw InvalidInput("keep: the scene has contact, which a data set cannot have; remove it");
  if (side.hand().is_grabbing()) throw InvalidInput("keep: the mouse pulls the body; release it first");
}

fs::path new_folder(const std::string& name) {
  const fs::path all = fs::path("out") / "bench";
  fs::create_directories(all);
  for (int i = 1;; ++i)
    if (const fs::path folder = all / fmt::format("{}_{}", name, i); !fs::exists(folder)) return folder;
}

}  // namespace

viewer::SessionExtension bench() {
  return {.make_tool = [](Model& model) { return std::make_unique<IndenterTool>(model); },
          .make_desk = [](auto&&... parts) { return std::make_unique<BenchDesk>(parts...); }};
}

BenchDesk::BenchDesk(const viewer::SessionOptions& options, Stage& stage, viewer::Playback& playback,
                     viewer::Commands& commands, viewer::Questions& questions)
    : options_(options), stage_(stage), playback_(playback) {
  commands["touch"] = {[this](Arguments& a) { touch(a); }};
  commands["press"] = {[this](Arguments& a) { press(a); }};
  commands["lift"] = {viewer::plain([this] { lift(); })};
  commands["keep"] = {viewer::plain([this] { keep(); }), false};
  commands["forget"] = {[this](Arguments& a) { forget(a); }, false};
  commands["fit"] = {viewer::plain([this] { fit(); }), false};
  commands["stop_fit"] = {viewer::plain([this] {
                            if (fit_) fit_->stop();
                          }),
                          false};
  questions["fit_state"] = [this](Arguments& arguments) {
    arguments.finish();
    return fit_ ? fit_->state() : Json();
  };
  questions["fit_report"] = [this](Arguments& arguments) {
    arguments.finish();
    if (!fit_ || !fs::exists(fit_->report())) throw InvalidInput("there is no report yet; fit the readings first");
    return viewer::file_reply("report.html", read_file(fit_->report()));
  };
}

const IndenterTool& BenchDesk::tool() const { return tool_of(stage_.a().side); }

// ---------------------------------------------------------------- the indenter

// The indenter touches the boundary of the tets, even if a skin is shown.
void BenchDesk::touch(Arguments& arguments) {
  const ShownSide& touched = stage_.named(arguments);
  const int triangle = arguments.integer("triangle", 0, touched.surface.triangle_count() - 1);
  const SurfacePoint shown_point{triangle, arguments.weights("weights")};
  const Model& model = stage_.a().side.model();
  const Indenter indenter = indenter_of(arguments, model, viewer::boundary_of(model));
  arguments.finish();
  if (tool().depth() != 0)
    throw InvalidInput("touch: the indenter presses on the body; lift it, and let the body rest before the next place");
  const Surface& surface = stage_.a().surface;
  const SurfacePoint point = same_point(touched.surface, shown_point, surface);
  std::vector<std::shared_ptr<const FirstContact>> touches;
  for (const ShownSide& shown : stage_.sides()) {
    const Surface cage = viewer::boundary_of(shown.side.model());
    touches.push_back(std::make_shared<const FirstContact>(touch_at(
        shown.side.model(), cage, same_point(surface, point, cage), indenter, shown.side.simulation().state().q)));
  }
  for (size_t s = 0; s < touches.size(); ++s)
    stage_.sides()[s].side.edit([&](Tools& tools, Positions) { tool_of(tools).touch(touches[s]); });
  Json done = indenter_json(indenter);
  done.update({{"do", "touch"}, {"side", "a"}, {"triangle", point.triangle}, {"weights", point.weights.a}});
  stage_.record(std::move(done));
}

void BenchDesk::press(Arguments& arguments) {
  const double depth = arguments.number("depth"), most = kTooFar * size_of(stage_.a().surface);
  arguments.finish();
  if (!tool().touch()) throw InvalidInput("press: there is no indenter; place it on the body first");
  if (!(std::abs(depth) <= most)) refuse("press.depth", depth, fmt::format("at most {:g} m is expected", most));
  stage_.record({{"do", "press"}, {"depth", depth}});
  for (ShownSide& shown : stage_.sides())
    if (tool_of(shown.side).touch()) shown.side.aim([&](Tools& tools) { tool_of(tools).press(depth); });
}

void BenchDesk::lift() {
  if (!tool().touch()) return;
  stage_.record({{"do", "lift"}});
  for (ShownSide& shown : stage_.sides()) shown.side.edit([](Tools& tools, Positions) { tool_of(tools).lift(); });
}

// ---------------------------------------------------------------- readings

const IndenterTool& BenchDesk::resting_tool() const {
  const Side& side = stage_.a().side;
  const IndenterTool& indenter = tool();
  if (!indenter.touch()) throw InvalidInput("keep: there is no indenter; place it on the body first");
  if (indenter.wanted() == 0) throw InvalidInput("keep: the depth is 0; press the indenter in first");
  const double work = std::abs(indenter.force(side.positions()) * indenter.depth());
  const double kinetic = side.simulation().kinetic_energy();
  if (side.iteration() >= 0 || indenter.depth() != indenter.wanted() || !(kinetic <= kAtRest * work))
    throw InvalidInput(
        fmt::format("keep: the body still moves (kinetic energy {:.2g} J); play until it rests, or set time.integrator "
                    "to quasi_static",
                    kinetic));
  return indenter;
}

void BenchDesk::keep() {
  const Side& side = stage_.a().side;
  require_measurable(side);
  const IndenterTool& indenter = resting_tool();
  const FirstContact& site = *indenter.touch();
  if (readings_.size() >= kMaxReadings)
    throw InvalidInput(fmt::format("keep: at most {} readings are kept; forget some", kMaxReadings));
  if (readings_.empty()) true_material(side.steered().scene), body_ = body_text(side);  // throws for other bodies
  if (&site != last_site_.get()) ++sites_, last_site_ = indenter.touch();
  LoadCase load;
  load.group = fmt::format("poke {}", sites_);
  load.name = fmt::format("{}, {:.6g} mm", load.group, 1e3 * indenter.depth());
  load.indenter = site.indenter;
  load.touch = site.rest;
  load.pose = indenter.pose();
  load.gravity = side.steered().document.find("gravity")->vector();
  for (const Reading& known : readings_)
    if (known.load.name == load.name) throw InvalidInput("keep: this reading is kept already");
  readings_.push_back({load, indenter.depth(), indenter.force(side.positions())});
  const auto place = [](const Reading& r) { return std::pair(r.load.group.size(), r.load.group); };
  std::stable_sort(readings_.begin(), readings_.end(), [&](const Reading& r, const Reading& s) {
    return place(r) != place(s) ? place(r) < place(s) : r.depth < s.depth;
  });
  send();
}

void BenchDesk::forget(Arguments& arguments) {
  const int one =
      arguments.has("reading") ? arguments.integer("reading", 0, static_cast<int>(readings_.size()) - 1) : -1;
  arguments.finish();
  one < 0 ? readings_.clear() : void(readings_.erase(readings_.begin() + one));
  send();
}

void BenchDesk::check_body() {
  if (!readings_.empty() && body_text(stage_.a().side) != body_) readings_.clear();
  send();
}

// ---------------------------------------------------------------- the fit

void BenchDesk::fit() {
  if (fit_ && fit_->is_running()) throw InvalidInput("a fit is running; stop it first");
  if (readings_.empty()) throw InvalidInput("no reading is kept yet; press the indenter in and keep one");
  viewer::Busy busy(options_);
  busy("simulating the readings with noise, for a data set");
  const Scene& scene = stage_.a().side.steered().scene;
  SynthesisOptions options{.indentations = 0, .stop = playback_.stop_token()};
  for (const Reading& reading : readings_) options.cases.push_back(reading.load);
  const Synthesis made = synthesize(scene, options);
  if (made.interrupted) throw InvalidInput("interrupted; no fit was started");
  if (made.failed > 0) throw InvalidInput(made.notes.back() + "; press less deep, or forget this reading");
  const fs::path folder = new_folder(viewer::saved_name(scene));
  write_data_set(folder, made.data, [&](const fs::path& place) {
    write_material(place / "truth.vtu", made.truth);
    write_file(place / "aspic.fit.toml", kFitOptions);
  });
  fit_ = std::make_unique<FitProcess>(folder, made.truth);
  send();
}

void BenchDesk::send() const {
  Json readings = Json::array();
  for (const Reading& reading : readings_)
    readings.push_back({{"name", reading.load.group},
                        {"radius", reading.load.indenter->radius},
                        {"depth", reading.depth},
                        {"force", reading.force}});
  stage_.send(viewer::text({{"kind", "bench"},
                            {"radius", default_radius(viewer::boundary_of(stage_.a().side.model()))},
                            {"readings", std::move(readings)}}));
}

}  // namespace aspic::bench
