#include "io/xml.h"

#include <expat.h>

#include <algorithm>
#include <array>
#include <climits>
#include <memory>
#include <new>

#include "base/error.h"
#include "base/printable.h"
#include "io/blank.h"

namespace aspic {
namespace {

constexpr size_t kMaxDepth = 32;
constexpr int kMaxElements = 100000;  // limits the memory for hostile files

constexpr std::array<std::pair<std::string_view, char>, 5> kEntities = {
    {{"&amp;", '&'}, {"&lt;", '<'}, {"&gt;", '>'}, {"&quot;", '"'}, {"&apos;", '\''}}};

// Builds the tree from Expat's events. Stores errors, because exceptions must not pass through Expat.
class Builder {
 public:
  Builder(std::string_view document, const std::string& file, std::string_view verbatim)
      : document_(document), file_(file), verbatim_(verbatim), parser_(XML_ParserCreate(nullptr), XML_ParserFree) {
    if (!parser_) throw std::bad_alloc();
    XML_SetUserData(parser_.get(), this);
    XML_SetElementHandler(
        parser_.get(),
        [](void* self, const char* name, const char** attributes) { of(self).begin_element(name, attributes); },
        [](void* self, const char*) { of(self).open_.pop_back(); });
    XML_SetCharacterDataHandler(parser_.get(), [](void* self, const char* text, int size) {
      of(self).add_text({text, static_cast<size_t>(size)});
    });
    XML_SetStartDoctypeDeclHandler(parser_.get(), [](void* self, const char*, const char*, const char*, int) {
      of(self).refuse("DOCTYPE is not supported");
    });
    XML_SetStartCdataSectionHandler(parser_.get(), [](void* self) { of(self).refuse("CDATA is not supported"); });
  }

  XmlElement root() {
    constexpr size_t kChunk = INT_MAX;
    for (size_t first = 0; first == 0 || first < document_.size(); first += kChunk) {
      const std::string_view chunk = document_.substr(first, kChunk);
      const bool is_last = first + chunk.size() == document_.size();
      if (XML_Parse(parser_.get(), chunk.data(), static_cast<int>(chunk.size()), is_last) != XML_STATUS_OK) break;
    }
    if (XML_GetErrorCode(parser_.get()) != XML_ERROR_NONE && !has_ended_) fail();
    return std::move(root_);
  }

 private:
  static Builder& of(void* self) { return *static_cast<Builder*>(self); }
  size_t position() const { return static_cast<size_t>(XML_GetCurrentByteIndex(parser_.get())); }
  int line() const { return static_cast<int>(XML_GetCurrentLineNumber(parser_.get())); }

  void refuse(const std::string& error) {
    error_ = error;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  [[noreturn]] void fail() const {
    std::string what = error_.empty() ? XML_ErrorString(XML_GetErrorCode(parser_.get())) : error_;
    if (elements_ == 0 && error_.empty()) what.insert(0, "not an XML file: ");
    if (!open_.empty())
      what += ", in <" + printable(open_.back()->name) + "> from line " + std::to_string(open_.back()->line);
    throw InvalidInput(file_ + ":" + std::to_string(line()) + ": " + what);
  }

  void begin_element(const char* name, const char** attributes) {
    if (open_.size() >= kMaxDepth) return refuse("elements nest deeper than " + std::to_string(kMaxDepth));
    if (++elements_ > kMaxElements) return refuse("more than " + std::to_string(kMaxElements) + " elements");
    XmlElement& element = open_.empty() ? root_ : open_.back()->children.emplace_back();
    element.name = name;
    element.line = line();
    for (; *attributes; attributes += 2) element.attributes.emplace_back(attributes[0], printable(attributes[1]));
    open_.push_back(&element);
    const std::string_view tag = document_.substr(position(), XML_GetCurrentByteCount(parser_.get()));
    if (name != verbatim_ || tag.ends_with("/>")) return;
    element.text = document_.substr(position() + tag.size());
    has_ended_ = true;
    XML_StopParser(parser_.get(), XML_FALSE);
  }

  void add_text(std::string_view piece) {
    XmlElement& element = *open_.back();
    if (!element.text.empty() || std::all_of(piece.begin(), piece.end(), is_blank)) return;
    const char* end = document_.data() + document_.size();
    const char* first = std::find_if_not(document_.data() + position(), end, is_blank);
    element.text = {first, static_cast<size_t>(std::find(first, end, '<') - first)};
  }

  std::string_view document_;
  const std::string& file_;
  std::string_view verbatim_;
  std::unique_ptr<XML_ParserStruct, decltype(&XML_ParserFree)> parser_;
  XmlElement root_;
  std::vector<XmlElement*> open_;  // from the root to the innermost open element
  int elements_ = 0;
  bool has_ended_ = false;  // at the verbatim element
  std::string error_;
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
  return Builder(document, file, verbatim).root();
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
