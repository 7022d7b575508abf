#include "scene/scene_builder.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/formatted.h"
#include "base/printable.h"
#include "contact/barrier.h"
#include "dynamics/inflate.h"
#include "dynamics/integrator.h"
#include "dynamics/internal_terms.h"
#include "dynamics/simulation_checks.h"
#include "dynamics/touching.h"
#include "mesh/elements.h"
#include "scene/body_actions.h"
#include "scene/body_material.h"
#include "scene/body_notes.h"
#include "scene/body_rod.h"
#include "scene/body_sheet.h"
#include "scene/placement.h"
#include "scene/scene_attachments.h"
#include "scene/scene_contact.h"
#include "scene/schema.h"
#include "scene/solver_options.h"

namespace aspic {
namespace {

std::vector<MaterialParameters> from_user(const Renumbering& tet, const std::vector<MaterialParameters>& user) {
  std::vector<MaterialParameters> stored;
  stored.reserve(user.size());
  for (size_t t = 0; t < user.size(); ++t) stored.push_back(user[tet.to_user(static_cast<int>(t))]);
  return stored;
}

template <class T>
void append_to(std::vector<T>& all, const std::vector<T>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void note_duration(const Value& time, int steps, std::vector<std::string>& notes) {
  constexpr double kNoticed = 0.01;  // of the duration
  const double duration = time["duration"].number(), h = time["step"].number();
  if (steps * h - duration > kNoticed * duration)
    notes.push_back("time.duration = " + number_text(duration) + " is no multiple of time.step = " + number_text(h) +
                    ": the last step ends at t = " + number_text(steps * h) + " s");
}

class SceneBuilder {
 public:
  SceneBuilder(SceneSource source, SceneFiles files, const SceneOptions& options)
      : source_(std::move(source)), files_(std::move(files)), options_(options) {}

  SceneModel build_model() {
    if (options_.require) options_.require(source_.document);
    mark_version(source_.document, source_.notes);
    add_bodies();
    mesh_loader().report_if_many(model_.mesh.tet_count(),
                                 "setting up " + std::to_string(model_.mesh.vertex_count()) +
                                     " vertices: materials, mass and the pattern of the matrix");
    add_model();
    if (options_.amend) options_.amend(model_);
    State state = start();
    if (model_.contact) separate(state);
    const SimulationOptions options = simulation_options(source_.document, source_.notes);
    require_integrator(options.integrator);
    put_in_order(source_.document);
    source_.notes.insert(source_.notes.end(), warnings_.begin(), warnings_.end());
    for (auto* texts : {&source_.notes, &warnings_})
      for (std::string& text : *texts) text = printable(text);
    return {printable(source_.name),
            std::move(source_.document),
            std::move(source_.notes),
            std::move(warnings_),
            std::move(model_),
            std::move(state),
            options,
            std::move(files_.kept_files),
            std::move(files_.kept_meshes)};
  }

  Scene build() {
    SceneModel scene = build_model();
    const int steps = steps_of(*scene.document.find("time"));
    note_duration(*scene.document.find("time"), steps, scene.notes);
    const OutputOptions output = output_options(*scene.document.find("output"));
    const Vec3d gravity = scene.document.find("gravity")->vector();
    const std::string mesh_error = (*scene.document.find("solver"))["mesh_error"].text();
    try {
      Simulation simulation(std::move(scene.model), std::move(scene.start), scene.options);
      std::string warning = start_warning(simulation);
      if (!warning.empty()) scene.notes.push_back(warning), scene.warnings.push_back(warning);
      return {std::move(scene.name),
              to_toml(scene.document),
              std::move(scene.notes),
              std::move(warning),
              std::move(simulation),
              std::move(skins_),
              steps,
              std::move(scene.warnings),
              output,
              std::move(scene.input_files),
              std::move(scene.generated_meshes),
              gravity,
              mesh_error};
    } catch (const BadInitialState& e) {
      throw InvalidInput(source_.file + ": " + e.cause + "; " + remedy_in_scene(e.kind));
    } catch (const InvalidInput& e) {
      throw InvalidInput(source_.file + ": " + e.what());
    }
  }

 private:
  void require_integrator(const std::string& name) const {
    try {
      InternalTerms(model_).require_support(make_integrator(name)->facts());
    } catch (const InvalidInput& e) {
      throw error_at((*source_.document.find("time"))["integrator"].place, e.what());
    }
  }

  // Separates surfaces that touch or, if the scene allows it, overlap at the start.
  void separate(State& state) {
    MeshLoader loader = mesh_loader();
    note_touching(separate_touching(model_, state.q), model_, loader);
    const Value& start = (*source_.document.find("contact"))["start"];
    if (start.text() != "inflate") return;
    loader.report_if_many(model_.mesh.tet_count(), "moving bodies apart that overlap at the start");
    try {
      const std::vector<double> given = state.q;
      inflate(model_, state.q);
      if (state.q != given)
        loader.notes.push_back("bodies that overlapped at the start press on each other: contact stores " +
                               three_digits(model_.contact->energy(state.q, 0).total) + " J");
    } catch (const InvalidInput& e) {
      throw error_at(start.place, std::string("start = \"inflate\": ") + e.what());
    }
  }

  MeshLoader mesh_loader() {
    return {files_, options_.mesher, source_.notes, options_.announce, options_.limit, 0, options_.mesher_seconds};
  }

  void add_bodies() {
    MeshLoader loader = mesh_loader();
    for (Value& scene : source_.document.find("body")->array()) {
      std::optional<LoadedMesh> loaded;
      if (const auto known = source_.meshes.find(scene["name"].text()); known != source_.meshes.end())
        loaded = std::move(known->second);
      BodyMesh mesh = make_body_mesh(scene, loader, std::move(loaded));
      PlacedBody body{scene, std::move(mesh.tets), {}, model_.mesh.vertex_count(), model_.mesh.tet_count()};
      body.first_triangle = static_cast<int>(model_.mesh.sheet.size());
      body.first_segment = static_cast<int>(model_.mesh.rods.size());
      body.groups = std::move(mesh.groups);
      body.painted = std::make_shared<PaintedFields>(placement_of(scene), files_, body.name());
      try {
        body.start = deformed(scene, body.mesh.rest, files_, body.name());
      } catch (const InvalidInput& e) {
        throw InvalidInput(source_.file + ": body '" + body.name() + "', deform: " + e.what());
      }
      note_start(body, warnings_);
      add_to_model(body);
      for (Carrier& carrier : mesh.embedding.carriers)
        for (int n = 0; n < carrier.count; ++n) carrier.vertex[n] = body.model_vertex(carrier.vertex[n]);
      const double radius = body.mesh.radius.empty() ? 0 : body.mesh.radius.front();
      skins_.push_back({std::move(mesh.skin), std::move(mesh.embedding), body.name(), !body.mesh.sheet.empty(),
                        body.mesh.rods, radius, std::move(mesh.uv)});
      bodies_.push_back(std::move(body));
    }
  }

  // Afterwards its vertices and tets have numbers of the user and of the model.
  void add_to_model(PlacedBody& body) {
    const int vertices = body.mesh.vertex_count(), tets = body.mesh.tet_count();
    body.numbering = locality_numbering(body.mesh);
    append(from_user(body.numbering, body.mesh), model_.mesh);
    model_.numbering.vertex.append(body.first_vertex, body.numbering.vertex, vertices);
    model_.numbering.tet.append(body.first_tet, body.numbering.tet, tets);
    model_.bodies.push_back({body.name(), body.first_vertex, vertices, body.first_tet, tets, body.first_triangle,
                             static_cast<int>(body.mesh.sheet.size()), body.first_segment,
                             static_cast<int>(body.mesh.rods.size())});
  }

  void add_model() {
    const Value& solver = *source_.document.find("solver");
    const MassKind kind = solver["mass"].text() == "lumped" ? MassKind::lumped : MassKind::consistent;
    const SceneActions actions = {bodies_,
                                  source_.document.find("gravity")->vector(),
                                  source_.document.find("time")->find("duration")->number(),
                                  kind,
                                  files_,
                                  source_.notes,
                                  options_.limit.memory};
    add_pins(actions, model_);
    const std::vector<char> held = held_vertices();
    std::vector<MaterialParameters> of_sheets, of_rods;
    std::vector<double> density_of_sheets, density_of_rods;
    std::vector<RodSegment> segments;
    for (PlacedBody& body : bodies_) {
      const Renumbering& tet = body.numbering.tet;
      const BodyMaterial material = body_material(body, files_, source_.notes);
      note_stiffness(body, material, source_.document.find("gravity")->vector(),
                     source_.document.find("obstacle") != nullptr, warnings_);
      if (!body.mesh.sheet.empty()) {
        model_.elasticity.push_back(sheet_elasticity(body, material, held, model_));
        append_to(density_of_sheets, material.density);
        append_to(of_sheets, material.parameters);
        continue;
      }
      if (!body.mesh.rods.empty()) {
        model_.elasticity.push_back(rod_elasticity(body, material, held, model_, segments));
        append_to(density_of_rods, material.density);
        append_to(of_rods, material.parameters);
        continue;
      }
      append_to(model_.density, tet.from_user(material.density));
      const std::vector<MaterialParameters> parameters = from_user(tet, material.parameters);
      model_.elasticity.push_back(make_tet_elasticity(material.model, model_.mesh, body.first_tet, parameters));
      export_moduli(parameters, model_);
    }
    append_to(model_.density, density_of_sheets);
    append_to(model_.density, density_of_rods);
    export_moduli(of_sheets, model_);
    export_moduli(of_rods, model_);
    model_.numbering.tet.append(model_.mesh.tet_count(), {}, model_.mesh.element_count() - model_.mesh.tet_count());
    if (!segments.empty()) model_.damping.push_back(make_rod_bending(model_.mesh, segments));
    model_.mass = std::make_unique<MassMatrix>(model_.mesh, model_.density, kind, angle_masses(model_));
    add_loads_and_damping(actions, model_);
    add_wind(source_.document, bodies_, model_, warnings_);
    MeshLoader loader = mesh_loader();
    add_scene_contact(source_.document, loader, initial_positions(), model_);
    add_attachments(source_.document, bodies_, model_, source_.notes);
    for (const PlacedBody& body : bodies_) note_parts(body, model_, warnings_);
  }

  // Returns 1 for each vertex that pins hold in all directions.
  std::vector<char> held_vertices() const {
    const Pins pins(model_.pins, initial_positions());
    std::vector<char> held;
    for (int v = 0; v < pins.rows(); ++v) held.push_back(pins.holds(v));
    return held;
  }

  // Of the vertices.
  std::vector<double> initial_positions() const {
    std::vector<double> q;
    for (const PlacedBody& body : bodies_)
      for (const Vec3d& x : body.start) q.insert(q.end(), x.a, x.a + 3);
    return model_.numbering.vertex.from_user(q, 3);
  }

  State start() {
    State state;
    const std::vector<double> masses = model_.numbering.vertex.to_user(model_.mass->vertex_mass());
    const std::span<const double> mass(masses);
    for (const PlacedBody& body : bodies_) {
      std::vector<Vec3d> v;
      try {
        v = velocities(body.scene, body.mesh.rest, body.start, mass.subspan(body.first_vertex, body.start.size()));
      } catch (const InvalidInput& e) {
        throw error_at(body.scene["velocity"].place, e.what());
      }
      for (const Vec3d& velocity : v)
        for (int r = 0; r < 3; ++r) state.qdot.push_back(velocity[r]);
    }
    state.q = initial_positions();
    state.qdot = model_.numbering.vertex.from_user(state.qdot, 3);
    for (auto* v : {&state.q, &state.qdot}) v->resize(3 * static_cast<size_t>(model_.rows()), 0.0);
    return state;
  }

  SceneSource source_;
  SceneFiles files_;
  const SceneOptions& options_;
  std::vector<PlacedBody> bodies_;
  Model model_;
  std::vector<std::string> warnings_;  // see Scene
  std::vector<Skin> skins_;
};

}  // namespace

std::string remedy_in_scene(BadInitialState::Kind kind) {
  switch (kind) {
    case BadInitialState::Kind::inverted_tets:
      return "set material.model = \"stable_neo_hookean\", which tolerates inversion, or choose a smaller initial "
             "deformation";
    case BadInitialState::Kind::collapsed_triangles:
      return "choose a smaller initial deformation";
    case BadInitialState::Kind::no_mass:
      return "remove them (aspic check MESH --repair) or pin them";
    case BadInitialState::Kind::touches_itself:
      return "merge the coincident vertices (aspic check MESH --repair) or leave a gap";
  }
  return "";
}

SimulationOptions simulation_options(const Table& document, std::vector<std::string>& notes) {
  const Value& time = *document.find("time");
  SimulationOptions options;
  options.h = time["step"].number();
  options.integrator = time["integrator"].text();
  options.adaptive.tolerance = time["adaptive"]["tolerance"].number();
  const Value& solver = *document.find("solver");
  options.initial_guess = solver["initial_guess"].text();
  options.solver = solver_options(solver);
  if (const auto conflict = find_conflict(options)) {
    const Value& table = conflict->option == "adaptive" ? time : solver;
    throw error_at(table[conflict->option].place, conflict->reason);
  }
  if (!make_integrator(options.integrator)->facts().is_implicit && options.solver.method != SolverOptions().method)
    notes.push_back("integrator = '" + options.integrator + "' does not minimize: solver.method = '" +
                    options.solver.method + "' has no effect");
  return options;
}

OutputOptions output_options(const Value& table) {
  return {.every = table["every"].number(),
          .vtu = table["vtu"].boolean(),
          .obj = table["obj"].boolean(),
          .ply = table["ply"].boolean(),
          .pc2 = table["pc2"].boolean(),
          .usd = table["usd"].boolean(),
          .report = table["report"].boolean(),
          .double_precision = table["precision"].text() == "double",
          .mechanics = table["mechanics"].boolean(),
          .checkpoint_every = table["checkpoint_every"].number()};
}

void mark_version(Table& document, std::vector<std::string>& notes) {
  const std::string current = ASPIC_VERSION;
  if (const Value* made_by = document.find("version")) {
    if (made_by->text() != current)
      notes.push_back("this scene was resolved by version " + made_by->text() + "; this is " + current +
                      ", so the last digits may differ");
  }
  std::erase_if(document.members, [](const Member& m) { return m.key == "version"; });
  document.members.insert(document.members.begin(), Member{"version", {}, {current, {}}});
}

void export_moduli(std::span<const MaterialParameters> parameters, Model& model) {
  if (model.tet_fields.empty()) model.tet_fields = {{"young", {}}, {"poisson", {}}};
  for (auto& [name, values] : model.tet_fields) values.reserve(values.size() + parameters.size());
  for (const MaterialParameters& p : parameters) {
    const bool elastic = p.lame.mu > 0;
    model.tet_fields[0].second.push_back(elastic ? young_modulus(p.lame) : 0);
    model.tet_fields[1].second.push_back(elastic ? poisson_ratio(p.lame) : 0);
  }
}

int steps_of(const Value& time) {
  const double duration = time["duration"].number(), h = time["step"].number();
  // Rounded quotient: 2 / 0.01 must not become 201 steps.
  const double steps = std::ceil(duration / h - 1e-6);
  if (steps > 1e9)
    throw error_at(time["duration"].place, "duration = " + number_text(duration) + " needs " + number_text(steps) +
                                               " steps; choose a longer step");
  return static_cast<int>(std::max(steps, 0.0));
}

SceneModel build_scene_model(SceneSource source, SceneFiles files, const SceneOptions& options) {
  return SceneBuilder(std::move(source), std::move(files), options).build_model();
}

Scene build_scene(SceneSource source, SceneFiles files, const SceneOptions& options) {
  return SceneBuilder(std::move(source), std::move(files), options).build();
}

}  // namespace aspic
