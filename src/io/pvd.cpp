#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/vtu.h"
#include "io/xml.h"

namespace aspic {

void write_pvd(const std::filesystem::path& path, const std::vector<std::pair<double, std::string>>& frames) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  for (const auto& [time, file] : frames) {
    text += "<DataSet timestep=\"";
    append_number(text, time);
    text += "\" group=\"\" part=\"0\" file=\"" + xml_escaped(file) + "\"/>\n";
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(path, text);
}

}  // namespace aspic
