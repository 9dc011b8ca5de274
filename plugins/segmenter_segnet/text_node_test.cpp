#include "segmenter_segnet/text_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TextNode parse(std::string_view text) { return parse_text(text, "net.prototxt"); }

std::string message_of(std::string_view text) {
  try {
    parse(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kData);
    return error.what();
  }
  return "nothing was thrown";
}

TEST(TextNode, ScalarsAndMessagesAreFields) {
  const TextNode root =
      parse("name: \"net\"\nlayer { name: 'a' }  # end\nlayer: { name: 'b' n: 3 }");
  EXPECT_EQ(root.text("name"), "net");
  ASSERT_EQ(root.all("layer").size(), 2u);
  EXPECT_EQ(root.all("layer")[0]->text("name"), "a");
  EXPECT_EQ(root.all("layer")[1]->integer("n", 0), 3);
  EXPECT_EQ(root.all("layer")[1]->where, "net.prototxt:3");
  EXPECT_EQ(root.find("other"), nullptr);
  EXPECT_EQ(root.text("other", "none"), "none");
}

TEST(TextNode, AllWaysToWriteTheSameAreUnderstood) {
  for (const char* text : {"shape { dim: 1 dim: -3 }", "shape < dim: 1, dim: -3 >",
                           "shape:{dim:[1,-3]}", "shape{#c\ndim:1;dim:-3;}"}) {
    const TextNode root = parse(text);
    ASSERT_NE(root.find("shape"), nullptr) << text;
    ASSERT_EQ(root.find("shape")->all("dim").size(), 2u) << text;
    EXPECT_EQ(root.find("shape")->integer("dim", 0), -3) << "the last one counts";
  }
  EXPECT_EQ(parse("s: 'a' \"b\\\"c\"").text("s"), "ab\"c");
  EXPECT_EQ(parse("s: 'a # no comment'").text("s"), "a # no comment");
  EXPECT_TRUE(parse("b: true").boolean("b", false));
  EXPECT_FALSE(parse("b: 0").boolean("b", true));
}

TEST(TextNode, EmptyTextsHaveNoFields) {
  for (const char* text : {"", "  \n", "# comment", "# comment\n"})
    EXPECT_TRUE(parse(text).fields.empty()) << text;
}

TEST(TextNode, MistakesAreToldWithTheirLine) {
  EXPECT_THAT(message_of("a: 1\nlayer {\n  b: 2\n"), StartsWith("net.prototxt:4: the text ends"));
  EXPECT_THAT(message_of("a: 1\n}"), StartsWith("net.prototxt:2: expected the name"));
  EXPECT_THAT(message_of("a 1"), HasSubstr("expected ':' or '{' after 'a'"));
  EXPECT_THAT(message_of("a: }"), HasSubstr("expected a value for 'a'"));
  EXPECT_THAT(message_of("a: 'b\nc'"), HasSubstr("a string does not end"));
  EXPECT_THAT(message_of("a: 'b"), HasSubstr("a string does not end"));
  EXPECT_THAT(message_of("a: [1, 2"), HasSubstr("does not end"));
  EXPECT_THAT(message_of("<!DOCTYPE html>"), HasSubstr("expected the name of a field"));
  std::string deep;
  for (int i = 0; i < 100000; ++i) deep += "a {";
  EXPECT_THAT(message_of(deep), HasSubstr("nested too deeply"));
}

TEST(TextNode, NumbersAreChecked) {
  const TextNode root = parse("a: 1.5\nb: maybe");
  EXPECT_THROW(root.integer("a", 0), Error);
  EXPECT_THROW(root.boolean("b", false), Error);
}

}  // namespace
}  // namespace stillpoint::segmenter_segnet
