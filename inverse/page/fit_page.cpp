#include "page/fit_page.h"

#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "io/base64.h"
#include "io/gzip.h"
#include "model/quantity.h"
#include "optimize/minimize.h"
#include "pipeline/case_figures.h"
#include "pipeline/fitted_values.h"
#include "viewer/page.h"
#include "viewer/recording_code.h"

namespace aspic::viewer {
namespace {

constexpr std::string_view kFitBegin = "<script type=\"application/json\" id=\"fit\">\"", kFitEnd = "\"</script>";
constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();

// Returns null for infinity and NaN, which JSON cannot represent.
Json number_json(double value) { return std::isfinite(value) ? Json(value) : Json(); }
std::vector<float> floats(const std::vector<double>& values) { return {values.begin(), values.end()}; }

void append(const Vec3d& v, std::vector<float>& list) {
  for (int i = 0; i < 3; ++i) list.push_back(static_cast<float>(v[i]));
}
void append_nothing(std::vector<float>& list) { list.insert(list.end(), 3, kNotANumber); }

class FitPack {
 public:
  explicit FitPack(const FitPageContent& content)
      : data_(content.data), outcome_(content.outcome), history_(content.history), figures_(content.figures) {
    for (size_t c = 0; c < outcome_.cases.size(); ++c)
      shown_.push_back(shown_readings(data_.experiment.cases[c], outcome_.cases[c]));
    choose_markers();
  }

  std::string text() {
    add_body();
    add_readings();
    Json head = {{"format", 1},
                 {"name", data_.name},
                 {"version", ASPIC_VERSION},
                 {"model", outcome_.plan.model},
                 {"counts", counts()},
                 {"fit", fit_json()},
                 {"quantities", quantities()},
                 {"cases", cases()},
                 {"figures", Json::parse(figures_)},
                 {"history", history()},
                 {"weights", weights()},
                 {"fibres", fibres()},
                 {"notes", data_.notes},
                 {"warnings", outcome_.warnings},
                 {"markerNames", marker_names()}};
    std::string text;
    append_base64(gzipped(pack_.bytes(std::move(head))), text);
    return text;
  }

 private:
  // All markers, or those of the shown readings if there are too many.
  void choose_markers() {
    const size_t count = data_.experiment.markers.size();
    std::vector<char> is_used(count, count <= kMaxShownReadings);
    for (size_t c = 0; c < shown_.size(); ++c)
      for (const int i : shown_[c]) is_used[data_.experiment.cases[c].positions[i].marker] = 1;
    index_of_.resize(count, 0);
    for (size_t m = 0; m < count; ++m)
      if (is_used[m]) index_of_[m] = static_cast<uint32_t>(markers_.size()), markers_.push_back(static_cast<int>(m));
  }

  Json marker_names() const {
    Json names = Json::array();
    for (const int m : markers_) names.push_back(data_.marker_names.empty() ? "" : data_.marker_names[m]);
    return names;
  }

  void add_body() {
    const TetMesh& mesh = outcome_.material.mesh;
    std::vector<float> points, markers;
    for (const Vec3d& X : mesh.rest) append(X, points);
    std::vector<uint32_t> tets, fixed;
    for (const Tet& tet : mesh.tets) tets.insert(tets.end(), tet.begin(), tet.end());
    for (const int m : markers_) append(at_rest(data_.experiment, data_.experiment.markers[m]), markers);
    for (const int v : data_.experiment.fixed)
      fixed.push_back(static_cast<uint32_t>(data_.numbering.vertex.to_user(v)));
    pack_.add("points", points);
    pack_.add("tets", tets);
    pack_.add("fixed", fixed);
    pack_.add("markers", markers);
    for (const auto* list : {&outcome_.material.values, &outcome_.material.further})
      for (const auto& [name, values] : *list) pack_.add("tet." + name, floats(values));
  }

  void add_readings() {
    std::vector<uint32_t> marker;
    std::vector<float> measured, sigma, predicted, on_mesh, held_out;
    for (size_t c = 0; c < data_.experiment.cases.size(); ++c) {
      const LoadCase& load = data_.experiment.cases[c];
      const CaseOutcome& outcome = outcome_.cases[c];
      for (const int i : shown_[c]) {
        marker.push_back(index_of_[load.positions[i].marker]);
        append(load.positions[i].position, measured);
        append(outcome.marker_sigma.empty() ? load.positions[i].sigma : outcome.marker_sigma[i], sigma);
        outcome.ok ? append(outcome.markers[i], predicted) : append_nothing(predicted);
        outcome.ok ? append(outcome.markers_on_mesh[i], on_mesh) : append_nothing(on_mesh);
        outcome.has_held_out ? append(outcome.held_out_markers[i], held_out) : append_nothing(held_out);
      }
    }
    pack_.add("reading.marker", marker);
    pack_.add("reading.measured", measured);
    pack_.add("reading.deviation", sigma);
    pack_.add("reading.predicted", predicted);
    pack_.add("reading.onMesh", on_mesh);
    pack_.add("reading.heldOut", held_out);
  }

  Json counts() const {
    const Experiment& e = data_.experiment;
    return {{"vertices", e.mesh.vertex_count()},
            {"tets", e.mesh.tet_count()},
            {"markers", e.markers.size()},
            {"cases", e.cases.size()},
            {"parameters", outcome_.parameter_count},
            {"residuals", outcome_.residuals},
            {"equilibria", outcome_.counts.equilibria}};
  }

  Json fit_json() const {
    const FitReport& r = outcome_.report;
    return {
        {"words", r.message},
        {"success", is_success(r.status)},
        {"interrupted", outcome_.interrupted},
        {"method", r.method},
        {"rule", outcome_.plan.fit.weight_rule},
        {"mesh", describe_mesh(outcome_)},
        {"iterations", r.iterations},
        {"weight", number_json(r.weight)},
        {"misfit", number_json(r.misfit)},
        {"roughness", number_json(r.roughness)},
        {"uniformMisfit", outcome_.uniform ? number_json(outcome_.uniform->misfit) : Json()},
        {"informed", outcome_.posterior && outcome_.posterior->ok ? number_json(outcome_.posterior->informed) : Json()},
        {"noiseFactor",
         outcome_.posterior && outcome_.posterior->ok ? number_json(outcome_.posterior->noise_factor) : Json()}};
  }

  Json fibres() const {
    Json list = Json::array();
    for (const FoundFibres& f : outcome_.fibres) list.push_back(f.where + ": " + fibre_text(f) + ".");
    return list;
  }

  Json quantities() const {
    Json list = Json::array();
    for (const FittedQuantity& q : outcome_.quantities) {
      Json rows = Json::array();
      for (const ValueRow& row : q.rows)
        rows.push_back({{"where", row.where},
                        {"value", number_json(row.value)},
                        {"lower", row.interval ? number_json(row.interval->lower) : Json()},
                        {"upper", row.interval ? number_json(row.interval->upper) : Json()}});
      list.push_back({{"name", q.name},
                      {"unit", q.unit},
                      {"isLog", is_stiffness(q.name)},
                      {"varies", q.parameterization != Parameterization::uniform},
                      {"hasDeviation", !q.sigma.empty()},
                      {"rows", rows}});
    }
    for (const auto& [name, value] : outcome_.plan.known)
      list.push_back(
          {{"name", name},
           {"unit", ""},
           {"isLog", false},
           {"varies", false},
           {"hasDeviation", false},
           {"rows", Json::array({{{"where", "given"}, {"value", value}, {"lower", nullptr}, {"upper", nullptr}}})}});
    return list;
  }

  Json cases() const {
    Json list = Json::array();
    size_t first = 0;
    for (size_t c = 0; c < data_.experiment.cases.size(); ++c) {
      const LoadCase& load = data_.experiment.cases[c];
      const CaseOutcome& outcome = outcome_.cases[c];
      Json item = {{"name", load.name},
                   {"group", load.group},
                   {"first", first},
                   {"count", shown_[c].size()},
                   {"hidden", load.positions.size() - shown_[c].size()},
                   {"leftOut", outcome.left_out},
                   {"ok", outcome.ok}};
      list.push_back(std::move(item));
      first += shown_[c].size();
    }
    return list;
  }

  Json history() const {
    Json list = Json::array();
    for (const FitIteration& i : history_)
      list.push_back({{"iteration", i.index},
                      {"start", i.start},
                      {"weight", number_json(i.weight)},
                      {"misfit", number_json(i.misfit)},
                      {"roughness", number_json(i.roughness)},
                      {"objective", number_json(i.objective)},
                      {"decrement", number_json(i.decrement)}});
    return list;
  }

  Json weights() const {
    Json list = Json::array();
    for (const WeightTrial& w : outcome_.report.weights)
      list.push_back({{"weight", number_json(w.weight)},
                      {"misfit", number_json(w.misfit)},
                      {"roughness", number_json(w.roughness)}});
    return list;
  }

  const DataSet& data_;
  const FitOutcome& outcome_;
  const std::vector<FitIteration>& history_;
  const std::string& figures_;
  std::vector<std::vector<int>> shown_;  // readings in the page, per case
  std::vector<int> markers_;             // in the page
  std::vector<uint32_t> index_of_;       // place of each marker in the page
  ArrayPack pack_;
};

}  // namespace

std::string fit_page(const FitPageContent& content) {
  return page_with(fmt::format("{}{}{}", kFitBegin, FitPack(content).text(), kFitEnd));
}

}  // namespace aspic::viewer
