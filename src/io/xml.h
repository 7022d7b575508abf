// XML as VTK files use it: elements, attributes and text, parsed by Expat. DTDs, and with them entity definitions, and
// CDATA are refused.
#pragma once
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace aspic {

struct XmlElement {
  std::string name;
  std::vector<std::pair<std::string, std::string>> attributes;
  std::vector<XmlElement> children;
  std::string_view text;  // the first run of characters that is not blank, entities untouched; views the document
  int line = 0;           // of the start tag

  const std::string* attribute(std::string_view wanted) const;  // null when absent
  const XmlElement* child(std::string_view wanted) const;       // the first of that name; null when absent
};

// The root element. `document` must outlive it. An element named `verbatim` ends the document: its text is everything
// that follows its start tag, however binary (VTK appends raw data that way). Throws InvalidInput naming `file`, the
// line and what is wrong; elements nest at most 32 deep.
XmlElement parse_xml(std::string_view document, const std::string& file, std::string_view verbatim = {});

// The text with & < > " and ' replaced, for use between quotes or tags.
std::string xml_escaped(std::string_view text);

}  // namespace aspic
