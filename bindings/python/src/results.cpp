// Results of runs: frames, and the page that plays a run.
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "arrays.h"
#include "base/error.h"
#include "bindings.h"
#include "interpreter.h"
#include "io/pc2.h"
#include "io/vtu.h"
#include "results/run_directory.h"
#ifdef ASPIC_HAS_VIEWER
#include "io/base64.h"
#include "io/gzip.h"
#include "viewer/recording.h"
#include "viewer/recording_code.h"
#endif

namespace aspic::python {
namespace {

namespace fs = std::filesystem;

py::dict dict_of(const std::vector<Field>& fields) {
  py::dict result;
  for (const Field& f : fields) {
    const auto rows = static_cast<py::ssize_t>(f.values.size()) / f.components;
    result[py::str(f.name)] = to_array(f.values, f.components == 1 ? Shape{rows} : Shape{rows, f.components});
  }
  return result;
}

py::dict read_frame(const fs::path& path) {
  Vtu vtu;
  {
    const ReleasedGil free;
    vtu = aspic::read_frame(path);
  }
  py::array_t<int> tets({static_cast<py::ssize_t>(vtu.mesh.tets.size()), py::ssize_t{4}});
  if (!vtu.mesh.tets.empty()) std::copy_n(vtu.mesh.tets.data()->data(), tets.size(), tets.mutable_data());
  py::dict result;
  result["points"] = to_array(vtu.mesh.rest);
  result["tets"] = tets;
  result["point_fields"] = dict_of(vtu.point_fields);
  result["cell_fields"] = dict_of(vtu.cell_fields);
  return result;
}

Array read_motion(const fs::path& path) {
  Pc2Reader reader(path);
  const py::ssize_t samples = reader.samples(), points = reader.points();
  Array motion({samples, points, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < samples; ++i) {
    const std::vector<float> sample = reader.sample(static_cast<int>(i));
    std::copy(sample.begin(), sample.end(), motion.mutable_data() + i * points * 3);
  }
  return motion;
}

#ifdef ASPIC_HAS_VIEWER
py::tuple page_of_run(const fs::path& run, size_t max_bytes) {
  viewer::RecordedRun page;
  {
    const ReleasedGil free;
    page = viewer::make_report(run, load_scene(scene_of_run(run)), {.max_bytes = max_bytes});
  }
  return py::make_tuple(page.text, page.note);
}

using Floats = py::array_t<float, py::array::c_style | py::array::forcecast>;

template <class T>
std::vector<T> numbers_of(const py::handle& array) {
  const auto values = array.cast<py::array_t<T, py::array::c_style>>();
  return {values.data(), values.data() + values.size()};
}

// Returns the page of a recording with the header `head`, these arrays of float32, uint32 or uint8, the positions of
// all frames, and the fields with one array per frame.
std::string page_of_arrays(const std::string& head, const py::dict& arrays, const std::vector<Floats>& frames,
                           const std::map<std::string, std::vector<Floats>>& fields) {
  viewer::ArrayPack pack;
  for (const auto& [name, array] : arrays) {
    const char kind = array.cast<py::array>().dtype().kind();
    if (kind == 'f')
      pack.add(name.cast<std::string>(), numbers_of<float>(array));
    else if (array.cast<py::array>().itemsize() == 1)
      pack.add(name.cast<std::string>(), numbers_of<uint8_t>(array));
    else
      pack.add(name.cast<std::string>(), numbers_of<uint32_t>(array));
  }
  const auto span_of = [](const Floats& values) {
    return std::span<const float>(values.data(), static_cast<size_t>(values.size()));
  };
  viewer::PositionRange range(span_of(frames.at(0)));
  for (const Floats& x : frames) range.add(span_of(x));
  viewer::PositionCode positions(range);
  for (const Floats& x : frames) positions.add(span_of(x));
  pack.add("positions", positions.bytes());
  for (const auto& [name, values] : fields) {
    viewer::ValueCode code;
    for (const Floats& of_frame : values) code.add(span_of(of_frame));
    pack.add(name, code.bytes());
    pack.add(name + ".range", code.ranges());
  }
  viewer::Json header = viewer::Json::parse(head);
  header["lower"] = range.lower.a;
  header["size"] = range.size().a;
  std::string text;
  append_base64(gzipped(pack.bytes(std::move(header))), text);
  return viewer::page_with_recording(text);
}
#else
std::string page_of_arrays(const py::args&) {
  throw std::runtime_error("this build of aspic has no viewer; build it with node and npm installed");
}

py::tuple page_of_run(const fs::path&, size_t) {
  throw std::runtime_error("this build of aspic has no viewer; build it with node and npm installed");
}
#endif

}  // namespace

void bind_results(py::module_& m) {
  m.def("read_frame", &read_frame);
  m.def("read_motion", &read_motion);
  m.def("page_of_run", &page_of_run);
  m.def("page_of_arrays", &page_of_arrays);
}

}  // namespace aspic::python
