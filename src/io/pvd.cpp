#include "io/atomic_file.h"
#include "io/number_text.h"
#include "io/vtu.h"
#include "io/xml.h"

namespace aspic {

void write_pvd(const std::string& path, const std::vector<std::pair<double, std::string>>& frames,
               const std::vector<std::string>& others) {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "<Collection>\n";
  const auto add = [&text](double time, const char* part, const std::string& file) {
    text += "<DataSet timestep=\"";
    append_number(text, time);
    text += std::string("\" group=\"\" part=\"") + part + "\" file=\"" + xml_escaped(file) + "\"/>\n";
  };
  for (size_t i = 0; i < frames.size(); ++i) {
    add(frames[i].first, "0", frames[i].second);
    if (!others.empty()) add(frames[i].first, "1", others[i]);
  }
  text += "</Collection>\n</VTKFile>\n";
  write_file(path, text);
}

}  // namespace aspic
