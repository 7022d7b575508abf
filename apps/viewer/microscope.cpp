#include "viewer/microscope.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/error.h"
#include "mesh/tet_shape.h"
#include "optimize/landscape.h"

namespace aspic::viewer {
namespace {

Json json_of(const Vec3d& x) { return {x[0], x[1], x[2]}; }
Json rows_of(const Mat3d& A) {
  Json rows = Json::array();
  for (int r = 0; r < 3; ++r) rows.push_back({A(r, 0), A(r, 1), A(r, 2)});
  return rows;
}
Vec3d at(std::span<const double> x, int vertex) { return {{x[3 * vertex], x[3 * vertex + 1], x[3 * vertex + 2]}}; }

Json corner_positions(const Side& side, int tet) {
  Json list = Json::array();
  for (const int v : side.model().mesh.tets[tet]) list.push_back(json_of(at(side.view().x, v)));
  return list;
}

Mat3d cauchy_of(const TetFields& fields, int tet) {
  const double* s = &fields.cauchy[6 * static_cast<size_t>(tet)];  // xx yy zz xy yz zx
  return {{s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2]}};
}

Json tet_field(const Model& model, const std::string& name, int tet) {
  for (const auto& [field, values] : model.tet_fields)
    if (field == name) return values[tet];
  return nullptr;
}

}  // namespace

Json vertex_reply(const Side& side, const Surface& surface, int vertex) {
  const Model& model = side.model();
  const View view = side.view();
  Json values = Json::object();
  FieldValues evaluate;
  std::vector<float> all(surface.rest.size());
  for (const Field& field : fields_of(model)) {
    evaluate.evaluate(field.name, view, surface, all);
    values[field.name] = all[vertex];
  }
  double mass = 0;
  for (int i = 0; i < 4; ++i)
    mass += surface.weights[vertex][i] * model.mass->vertex_mass()[surface.carrier[vertex][i]];
  const int user = surface.is_fine ? -1 : model.numbering.vertex.to_user(surface.anchor(vertex));
  return {{"vertex", user},
          {"first_entry", surface.is_fine ? -1 : 3 * user},
          {"rest", json_of(surface.rest[vertex])},
          {"position", json_of(surface.position(vertex, view.x))},
          {"velocity", json_of(surface.position(vertex, side.simulation().state().qdot))},
          {"mass", mass},
          {"pinned", side.is_pinned(surface.anchor(vertex))},
          {"values", std::move(values)}};
}

Json tet_reply(const Side& side, const Surface& surface, int triangle) {
  const Model& model = side.model();
  const int t = surface.tet[triangle];
  const TetFields fields = tet_fields_at(side.view());
  const Mat3d F = deformation_gradient(model.mesh, t, side.view().x);
  Json vertices = Json::array();
  for (const int v : model.mesh.tets[t]) vertices.push_back(model.numbering.vertex.to_user(v));
  const double size = volume(model.mesh, t);
  return {{"tet", model.numbering.tet.to_user(t)},
          {"corners", std::move(vertices)},
          {"positions", corner_positions(side, t)},
          {"F", rows_of(F)},
          {"J", determinant(F)},
          {"stretches", json_of(stretches(F))},
          {"cauchy", rows_of(cauchy_of(fields, t))},
          {"von_mises", fields.von_mises[t]},
          {"energy_density", fields.energy_density[t]},
          {"energy", size * fields.energy_density[t]},
          {"volume", size},
          {"quality", mean_ratio(corners(model.mesh, t))},
          {"young", tet_field(model, "young", t)},
          {"poisson", tet_field(model, "poisson", t)},
          {"density", model.density[t]}};
}

Json worst_reply(const Side& side) {
  const Model& model = side.model();
  const TetFields fields = tet_fields_at(side.view());
  Json items = Json::array();
  const auto add_tet = [&](const char* what, const char* unit, const std::vector<double>& values, double sign) {
    int worst = 0;
    for (int t = 1; t < model.mesh.tet_count(); ++t)
      if (sign * values[t] > sign * values[worst]) worst = t;
    items.push_back({{"what", what},
                     {"value", values[worst]},
                     {"unit", unit},
                     {"tet", model.numbering.tet.to_user(worst)},
                     {"vertex", -1},
                     {"positions", corner_positions(side, worst)}});
  };
  std::vector<double> quality;
  for (int t = 0; t < model.mesh.tet_count(); ++t) quality.push_back(mean_ratio(corners(model.mesh, t)));
  add_tet("smallest det F", "", fields.det_F, -1);
  add_tet("largest energy density", "J/m^3", fields.energy_density, 1);
  add_tet("largest von Mises stress", "Pa", fields.von_mises, 1);
  add_tet("worst shape at rest", "", quality, -1);
  if (const StepRow* last = side.rows().last(); last && last->report.worst_vertex >= 0)
    items.push_back({{"what", "largest residual of the last step"},
                     {"value", last->report.worst_residual},
                     {"unit", "N"},
                     {"tet", -1},
                     {"vertex", model.numbering.vertex.to_user(last->report.worst_vertex)},
                     {"positions", Json::array({json_of(at(side.view().x, last->report.worst_vertex))})}});
  return {{"items", std::move(items)}};
}

// ---------------------------------------------------------------- the landscape around an iteration

namespace {

constexpr size_t kMostOfPath = 1000;     // iterates
constexpr double kTetsToEvaluate = 3e7;  // by a slice: a second or two

int slice_samples(int tets) {
  const int samples = static_cast<int>(std::sqrt(kTetsToEvaluate / std::max(tets, 1)));
  return std::clamp(samples | 1, 9, 41);
}

// An iteration of a step, looked at while it is there. A step of several stages is several minimisations: iterations
// are counted over all of them, and the path is that of the one meant.
struct Look {
  int iteration = 0, first = 0, count = 0;  // wanted; of its minimisation; so far
  double value = 0, alpha = 0;
  std::vector<Trial> tried;
  std::vector<CurvePoint> curve;
  Slice slice;
  std::vector<double> x, d;

  bool is_met() const { return !x.empty(); }
  void take(const LiveIteration& live, double c, int tets) {
    value = live.value;
    alpha = live.alpha;
    tried.assign(live.tried.begin(), live.tried.end());
    x.assign(live.x.begin(), live.x.end());
    d.assign(live.d.begin(), live.d.end());
    curve = curve_along(live, c);
    slice = slice_through(live, slice_samples(tets));
  }
};

double scalar_product(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

// Where an iterate lies in the plane of the look.
Json on_plane(const Look& look, std::span<const double> x, double value) {
  std::vector<double> away(x.begin(), x.end());
  for (size_t i = 0; i < away.size(); ++i) away[i] -= look.x[i];
  const auto along = [&](const std::vector<double>& u) {
    const double uu = scalar_product(u, u);
    return uu > 0 ? scalar_product(away, u) / uu : 0;
  };
  return {{"s", along(look.d)}, {"t", along(look.slice.across)}, {"value", value}};
}

Json to_json(const Slice& slice) {
  Json s = Json::array(), t = Json::array(), value = Json::array(), model = Json::array();
  for (int column = 0; column < slice.columns; ++column) s.push_back(slice.point[column].s);
  for (int row = 0; row < slice.rows; ++row) t.push_back(slice.point[static_cast<size_t>(row) * slice.columns].t);
  for (const SlicePoint& point : slice.point) {
    value.push_back(point.value);
    model.push_back(point.model);
  }
  return {{"columns", slice.columns}, {"rows", slice.rows}, {"s", s}, {"t", t}, {"value", value}, {"model", model}};
}

std::string in_words(const StepReport& report, const StepRow* row) {
  if (report.status == Status::interrupted) return "the step was not followed to its end";
  std::string text = fmt::format("{} after {} iterations", to_string(report.status), report.iterations);
  if (row && !row->why.cause.empty()) text += fmt::format(": {}; {}", row->why.cause, row->why.remedy);
  return text;
}

}  // namespace

Json to_json(const std::vector<CurvePoint>& curve) {
  Json alpha = Json::array(), value = Json::array(), model = Json::array(), textbook = Json::array(),
       slide = Json::array();
  for (const CurvePoint& point : curve) {
    alpha.push_back(point.alpha);
    value.push_back(point.value);
    model.push_back(point.model);
    textbook.push_back(point.textbook_bound);
    slide.push_back(point.slide_bound);
  }
  return {{"alpha", alpha}, {"value", value}, {"model", model}, {"textbook", textbook}, {"slide", slide}};
}

Json iteration_reply(Side& side, int step, int iteration, const Consent& go_on) {
  const double c = side.simulation().options().solver.minimize.line_search.sufficient_decrease;
  const int tets = side.model().mesh.tet_count();
  Look look{.iteration = iteration};
  side.repeat(step, [&](const LiveIteration& live) {
    if (live.index == 0) look.first = look.count;
    if (look.count++ == iteration) look.take(live, c, tets);
    return !look.is_met() && go_on();
  });
  if (!go_on()) throw InvalidInput("the question was given up: something else is to be done");
  if (!look.is_met())
    throw InvalidInput(
        look.count == 0 ? fmt::format("step {} minimises nothing", step)
                        : fmt::format("iteration {}: step {} has iterations 0 to {}", iteration, step, look.count - 1));
  Json path = Json::array();
  int count = 0;
  Json end;
  const StepReport report = side.repeat(step, [&](const LiveIteration& live) {
    const bool is_meant = count >= look.first && (live.index > 0 || count == look.first) && path.size() < kMostOfPath;
    ++count;
    if (is_meant && live.index == static_cast<int>(path.size())) {
      path.push_back(on_plane(look, live.x, live.value));
      end = on_plane(look, live.x_next, std::numeric_limits<double>::quiet_NaN());
    }
    return go_on();
  });
  path.push_back(std::move(end));
  return {{"step", step},
          {"iteration", iteration},
          {"value", look.value},
          {"alpha", look.alpha},
          {"trials", to_json(look.tried)},
          {"curve", to_json(look.curve)},
          {"slice", to_json(look.slice)},
          {"path", std::move(path)},
          {"text", in_words(report, side.rows().find(step))}};
}

}  // namespace aspic::viewer
