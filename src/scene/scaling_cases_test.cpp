#include "scene/scaling_cases_test.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <regex>

namespace aspic::scaling {

std::string digits(double x) {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), x, std::chars_format::scientific).ptr;
  return {buffer.data(), end};
}

std::string in_units(const std::string& text, const Scales& scales) {
  static const std::regex quantity("<([-+0-9.e]+) ([A-Za-z0-9/^ ]+)>");
  std::string result;
  std::sregex_iterator it(text.begin(), text.end(), quantity), end;
  size_t done = 0;
  for (; it != end; ++it) {
    result.append(text, done, it->position() - done);
    result += digits(std::stod((*it)[1]) * scales.of((*it)[2]));
    done = it->position() + it->length();
  }
  return result + text.substr(done);
}

Outcome run(const Case& c, const Scales& scales) {
  const TestFolder folder;
  SceneOptions options;
  if (!c.mesh.empty()) std::filesystem::copy_file(c.mesh, folder / std::filesystem::path(c.mesh).filename());
  if (c.amend) options.amend = [&](Model& model) { c.amend(model, scales); };
  Scene scene = load_scene(folder.write("scene.toml", in_units(kTime + c.options + "\n" + c.bodies, scales)), options);
  Outcome outcome;
  for (int i = 0; i < std::min(scene.steps, c.steps); ++i) {
    const StepReport report = scene.simulation.step();
    outcome.status.emplace_back(to_string(report.status));
    for (const int count : {report.iterations, report.trials, report.substeps, report.rejected})
      outcome.counts.push_back(count);
    for (const double energy : {report.kinetic, report.potential_total})
      outcome.numbers.push_back(energy / scales.of("J") / 100);  // of the order of 100 J
    for (const double q : positions(scene)) outcome.numbers.push_back(q / scales.of("m"));
    for (const double v : velocities(scene)) outcome.numbers.push_back(v / scales.of("m/s"));
  }
  return outcome;
}

}  // namespace aspic::scaling
