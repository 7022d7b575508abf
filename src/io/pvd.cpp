#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/vtu.h"
#include "io/xml.h"

namespace aspic {

void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames,
               const std::string& fixed) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  const auto add = [&text](double time, const char* part, const std::string& file) {
    text += "<DataSet timestep=\"";
    append_number(text, time);
    text += std::string("\" group=\"\" part=\"") + part + "\" file=\"" + xml_escaped(file) + "\"/>\n";
  };
  for (const auto& [time, file] : frames) {
    add(time, "0", file);
    if (!fixed.empty()) add(time, "1", fixed);
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(path, text);
}

}  // namespace aspic
