#include "io/xml.h"

#include <algorithm>
#include <array>

#include "base/error.h"
#include "base/printable.h"
#include "io/blank.h"

namespace aspic {
namespace {

constexpr int kMaxDepth = 32;
constexpr int kMaxElements = 100000;  // bounds the memory that a hostile file can claim

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};

bool is_name_character(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-' ||
         c == '.' || c == ':';
}

class Parser {
 public:
  Parser(std::string_view document, const std::string& file, std::string_view verbatim)
      : document_(document), file_(file), verbatim_(verbatim) {}

  XmlElement parse_document() {
    if (document_.starts_with("\xEF\xBB\xBF")) advance(3);  // byte order mark
    skip_blanks_and_remarks();
    if (at_end() || document_[position_] != '<') fail("not an XML file: no element found");
    XmlElement root = parse_element(1);
    skip_blanks_and_remarks();
    if (!ended_ && !at_end()) fail("text after the end of <" + root.name + ">");
    return root;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InvalidInput(file_ + ":" + std::to_string(line_) + ": " + what);
  }

  bool at_end() const { return position_ >= document_.size(); }
  std::string_view rest() const { return document_.substr(position_); }

  void advance(size_t count) {
    const std::string_view passed = document_.substr(position_, count);
    line_ += static_cast<int>(std::count(passed.begin(), passed.end(), '\n'));
    position_ += passed.size();
  }

  void advance_past(std::string_view end, const char* what) {
    const size_t found = document_.find(end, position_);
    if (found == std::string_view::npos) fail(std::string(what) + " is not closed");
    advance(found + end.size() - position_);
  }

  void skip_blanks() {
    while (!at_end() && is_blank(document_[position_])) advance(1);
  }

  bool skip_remark() {
    if (rest().starts_with("<!--")) return advance_past("-->", "a comment"), true;
    if (rest().starts_with("<?")) return advance_past("?>", "a processing instruction"), true;
    if (rest().starts_with("<!")) fail("DOCTYPE and CDATA are not supported");
    return false;
  }

  void skip_blanks_and_remarks() {
    if (ended_) return;
    do skip_blanks();
    while (skip_remark());
  }

  std::string parse_name() {
    const size_t start = position_;
    while (!at_end() && is_name_character(document_[position_])) ++position_;
    if (position_ == start) fail("a name is missing");
    return std::string(document_.substr(start, position_ - start));
  }

  std::string unescaped(std::string_view text) const {
    std::string plain;
    for (size_t i = 0; i < text.size();) {
      if (text[i] != '&') {
        plain += text[i++];
        continue;
      }
      const auto entity = std::find_if(kEntities.begin(), kEntities.end(),
                                       [&](const auto& known) { return text.substr(i).starts_with(known.first); });
      if (entity == kEntities.end()) fail("unknown entity in an attribute");
      plain += entity->second;
      i += entity->first.size();
    }
    return plain;
  }

  std::pair<std::string, std::string> parse_attribute() {
    std::string name = parse_name();
    skip_blanks();
    if (at_end() || document_[position_] != '=') fail("attribute " + name + " has no value");
    advance(1);
    skip_blanks();
    if (at_end() || (document_[position_] != '"' && document_[position_] != '\'')) {
      fail("the value of attribute " + name + " is not quoted");
    }
    const size_t start = position_ + 1;
    const size_t end = document_.find(document_[position_], start);
    if (end == std::string_view::npos) fail("the value of attribute " + name + " is not closed");
    std::string value = printable(unescaped(document_.substr(start, end - start)));
    advance(end + 1 - position_);
    return {std::move(name), std::move(value)};
  }

  XmlElement parse_element(int depth) {
    if (depth > kMaxDepth) fail("elements nest deeper than " + std::to_string(kMaxDepth));
    if (++elements_ > kMaxElements) fail("more than " + std::to_string(kMaxElements) + " elements");
    XmlElement element;
    element.line = line_;
    advance(1);  // <
    element.name = parse_name();
    for (;;) {
      skip_blanks();
      if (at_end()) fail("<" + element.name + "> is not closed");
      if (rest().starts_with("/>")) return advance(2), element;
      if (document_[position_] == '>') break;
      element.attributes.push_back(parse_attribute());
    }
    advance(1);
    if (element.name == verbatim_) {
      element.text = rest();
      position_ = document_.size();
      ended_ = true;
    } else {
      parse_content(element, depth);
    }
    return element;
  }

  void parse_content(XmlElement& element, int depth) {
    while (!ended_) {
      skip_blanks();
      if (at_end()) fail("<" + element.name + "> from line " + std::to_string(element.line) + " is not closed");
      if (document_[position_] != '<') {
        const size_t end = std::min(document_.find('<', position_), document_.size());
        if (element.text.empty()) element.text = document_.substr(position_, end - position_);
        advance(end - position_);
      } else if (rest().starts_with("</")) {
        return parse_end_tag(element);
      } else if (!skip_remark()) {
        element.children.push_back(parse_element(depth + 1));
      }
    }
  }

  void parse_end_tag(const XmlElement& element) {
    advance(2);
    const std::string name = parse_name();
    if (name != element.name) fail("</" + name + "> where </" + element.name + "> was expected");
    skip_blanks();
    if (at_end() || document_[position_] != '>') fail("</" + name + " is not closed");
    advance(1);
  }

  std::string_view document_;
  const std::string& file_;
  std::string_view verbatim_;
  size_t position_ = 0;
  int line_ = 1, elements_ = 0;
  bool ended_ = false;  // by the verbatim element
};

}  // namespace

const std::string* XmlElement::attribute(std::string_view wanted) const {
  for (const auto& [key, value] : attributes) {
    if (key == wanted) return &value;
  }
  return nullptr;
}

const XmlElement* XmlElement::child(std::string_view wanted) const {
  for (const XmlElement& element : children) {
    if (element.name == wanted) return &element;
  }
  return nullptr;
}

XmlElement parse_xml(std::string_view document, const std::string& file, std::string_view verbatim) {
  return Parser(document, file, verbatim).parse_document();
}

std::string xml_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    const auto entity =
        std::find_if(kEntities.begin(), kEntities.end(), [&](const auto& known) { return known.second == c; });
    if (entity == kEntities.end()) {
      escaped += c;
    } else {
      escaped += entity->first;
    }
  }
  return escaped;
}

}  // namespace aspic
