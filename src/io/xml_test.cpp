#include "io/xml.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/error.h"

namespace aspic {
namespace {

std::string xml_message(std::string_view document) {
  try {
    parse_xml(document, "a.vtu");
  } catch (const InvalidInput& error) {
    return error.what();
  }
  return "";
}

TEST(Xml, ReadsElementsAttributesAndText) {
  const XmlElement root =
      parse_xml("<?xml version='1.0'?>\n<!-- <no/> --><a x = \"1 &lt; 2\" y='&quot;'>\n<b> 3 4 </b><b/></a>\n", "f");
  EXPECT_EQ(root.name, "a");
  EXPECT_EQ(root.line, 2);
  EXPECT_EQ(*root.attribute("x"), "1 < 2");
  EXPECT_EQ(*root.attribute("y"), "\"");
  EXPECT_EQ(root.attribute("z"), nullptr);
  ASSERT_EQ(root.children.size(), 2u);
  EXPECT_EQ(root.child("b")->text, "3 4 ");
  EXPECT_EQ(root.child("b")->line, 3);
}

TEST(Xml, EndsAtVerbatimElement) {
  const XmlElement root = parse_xml("<a><b/><raw n='1'>_<<&\"</raw></a>", "f", "raw");
  EXPECT_EQ(root.child("raw")->text, "_<<&\"</raw></a>");
}

TEST(Xml, NamesFileLineAndFault) {
  EXPECT_EQ(xml_message("<a>\n<b>\n</a>"), "a.vtu:3: mismatched tag, in <b> from line 2");
  EXPECT_EQ(xml_message(""), "a.vtu:1: not an XML file: no element found");
  EXPECT_EQ(xml_message("binary"), "a.vtu:1: not an XML file: syntax error");
  EXPECT_EQ(xml_message("<a>\n"), "a.vtu:2: no element found, in <a> from line 1");
  EXPECT_EQ(xml_message("<a"), "a.vtu:1: not an XML file: unclosed token");
  EXPECT_EQ(xml_message("<a b=c>"), "a.vtu:1: not an XML file: not well-formed (invalid token)");
  EXPECT_EQ(xml_message("<a b='&bomb;'/>"), "a.vtu:1: not an XML file: undefined entity");
  EXPECT_EQ(xml_message("<!DOCTYPE a><a/>"), "a.vtu:1: DOCTYPE is not supported");
  EXPECT_EQ(xml_message("<a/><b/>"), "a.vtu:1: junk after document element");
  EXPECT_EQ(xml_message("<a><![CDATA[1]]></a>"), "a.vtu:1: CDATA is not supported, in <a> from line 1");
  EXPECT_EQ(xml_message("<a b='\xff'/>"), "a.vtu:1: not an XML file: not well-formed (invalid token)");
}

TEST(Xml, BoundsDepthAndNumberOfElements) {
  std::string deep, many = "<a>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 100000; ++i) many += "<b/>";
  EXPECT_THAT(xml_message(deep), testing::HasSubstr("nest deeper than 32"));
  EXPECT_THAT(xml_message(many), testing::HasSubstr("more than 100000 elements"));
}

// Each entity would expand to ten copies of the previous one.
TEST(Xml, RejectsEntityExpansion) {
  std::string bomb = "<!DOCTYPE a [<!ENTITY e0 \"ha\">";
  for (int i = 1; i < 20; ++i) {
    bomb += "<!ENTITY e" + std::to_string(i) + " \"";
    for (int k = 0; k < 10; ++k) bomb += "&e" + std::to_string(i - 1) + ";";
    bomb += "\">";
  }
  EXPECT_EQ(xml_message(bomb + "]><a>&e19;</a>"), "a.vtu:1: DOCTYPE is not supported");
}

TEST(Xml, KeepsFirstTextOfElement) {
  const XmlElement root = parse_xml("<a>\n <b/> 1 2\n3 <c/> 4 <raw/></a>", "f", "raw");
  EXPECT_EQ(root.text, "1 2\n3 ");
  EXPECT_EQ(root.children.size(), 3u);
}

TEST(Xml, RejectsAnyPrefix) {
  const std::string whole = "<?xml version='1.0'?><a x='1'><b y=\"2\">text</b><!-- c --></a>";
  for (size_t n = 0; n < whole.size(); ++n) EXPECT_NE(xml_message(whole.substr(0, n)), "") << n;
  EXPECT_EQ(xml_message(whole), "");
}

TEST(Xml, EscapedTextReadsBack) {
  const std::string text = "a<b>&\"'c";
  const XmlElement root = parse_xml("<a x=\"" + xml_escaped(text) + "\"/>", "f");
  EXPECT_EQ(*root.attribute("x"), text);
}

}  // namespace
}  // namespace aspic
