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

TEST(Xml, EndsAtTheVerbatimElement) {
  const XmlElement root = parse_xml("<a><b/><raw n='1'>_<<&\"</raw></a>", "f", "raw");
  EXPECT_EQ(root.child("raw")->text, "_<<&\"</raw></a>");
}

TEST(Xml, NamesFileLineAndFault) {
  EXPECT_EQ(xml_message("<a>\n<b>\n</a>"), "a.vtu:3: </a> where </b> was expected");
  EXPECT_EQ(xml_message(""), "a.vtu:1: not an XML file: no element found");
  EXPECT_EQ(xml_message("binary"), "a.vtu:1: not an XML file: no element found");
  EXPECT_EQ(xml_message("<a>\n"), "a.vtu:2: <a> from line 1 is not closed");
  EXPECT_EQ(xml_message("<a"), "a.vtu:1: <a> is not closed");
  EXPECT_EQ(xml_message("<a b=c>"), "a.vtu:1: the value of attribute b is not quoted");
  EXPECT_EQ(xml_message("<a b='&bomb;'/>"), "a.vtu:1: unknown entity in an attribute");
  EXPECT_EQ(xml_message("<!DOCTYPE a><a/>"), "a.vtu:1: DOCTYPE and CDATA are not supported");
  EXPECT_EQ(xml_message("<a/><b/>"), "a.vtu:1: text after the end of <a>");
}

TEST(Xml, BoundsDepthAndNumberOfElements) {
  std::string deep, many = "<a>";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  for (int i = 0; i < 100000; ++i) many += "<b/>";
  EXPECT_THAT(xml_message(deep), testing::HasSubstr("nest deeper than 32"));
  EXPECT_THAT(xml_message(many), testing::HasSubstr("more than 100000 elements"));
}

TEST(Xml, AnyPrefixIsRefused) {
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
