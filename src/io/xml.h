// XML as VTK files use it: elements, attributes and text, parsed by Expat. Rejects CDATA and DTDs, and with them entity
// definitions.
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
  std::string_view text;  // first non-blank run of characters, with entities unexpanded; a view of the document
  int line = 0;           // line of the start tag

  const std::string* attribute(std::string_view wanted) const;  // null if absent
  const XmlElement* child(std::string_view wanted) const;       // first child of that name; null if absent
};

// Returns the root element. `document` must outlive it. An element named `verbatim` ends the document: its text is
// everything after its start tag, also binary data (VTK appends raw data this way). Throws InvalidInput with `file`,
// line and problem; elements nest at most 32 deep.
XmlElement parse_xml(std::string_view document, const std::string& file, std::string_view verbatim = {});

// Escapes & < > " and ', for use in attributes and text.
std::string xml_escaped(std::string_view text);

}  // namespace aspic
