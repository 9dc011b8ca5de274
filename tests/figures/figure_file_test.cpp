#include "figures/figure_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <boost/property_tree/ptree.hpp>
#include <boost/property_tree/xml_parser.hpp>
#include <fstream>
#include <sstream>

#include "picture.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::figures {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

Figure small_figure(const std::string& title) {
  Panel panel{title, {"time [s]"}, {"ATE [mm]"}};
  panel.marks.emplace_back(Line{title, {{0, 1}, {1, 2}}});
  Figure figure = figure_of(panel);
  figure.title = title;
  return figure;
}

/// Throws when it is not well-formed.
boost::property_tree::ptree parse_xml(const std::string& xml) {
  std::istringstream stream(xml);
  boost::property_tree::ptree tree;
  boost::property_tree::read_xml(stream, tree);
  return tree;
}

TEST(FigureFile, SvgIsWellFormedAndHasItsTitleAndSize) {
  const boost::property_tree::ptree tree = parse_xml(draw(small_figure("Errors"), Format::kSvg));
  EXPECT_EQ(tree.get<std::string>("svg.title"), "Errors");
  EXPECT_EQ(tree.get<std::string>("svg.<xmlattr>.width"), "252pt");
}

TEST(FigureFile, PdfIsOnePageWithoutADate) {
  const std::string pdf = draw(small_figure("Errors"), Format::kPdf);
  EXPECT_THAT(pdf, StartsWith("%PDF-1."));
  EXPECT_THAT(pdf, EndsWith("%%EOF\n"));
  EXPECT_THAT(pdf, HasSubstr("/Title (Errors)"));
  EXPECT_THAT(pdf, HasSubstr("/Count 1"));
  EXPECT_THAT(pdf, Not(HasSubstr("CreationDate")));
}

TEST(FigureFile, PngIsWhitePaperOfSuchWidth) {
  const Picture picture(small_figure("Errors"));
  EXPECT_EQ(picture.pixels().cols, 3 * 252);
  const cv::Vec3b white(255, 255, 255);
  EXPECT_EQ(picture.pixels().at<cv::Vec3b>(0, 0), white);
  EXPECT_EQ(picture.pixels().at<cv::Vec3b>(picture.pixels().rows - 1, picture.pixels().cols - 1),
            white);
}

TEST(FigureFile, TheSameFigureGivesTheSameBytes) {
  for (const Format format : {Format::kPng, Format::kSvg, Format::kPdf})
    EXPECT_EQ(draw(small_figure("Errors"), format), draw(small_figure("Errors"), format));
}

TEST(FigureFile, NamesMayBeAnything) {
  for (const std::string& name : {std::string("<&>\"'\n\x01"), std::string("caf\xe9 \xff\xfe"),
                                  std::string("große Karte 地図"), std::string(5, '\0')})
    for (const Format format : {Format::kPng, Format::kSvg, Format::kPdf}) {
      const std::string bytes = draw(small_figure(name), format);
      if (format == Format::kSvg) {
        EXPECT_NO_THROW(parse_xml(bytes)) << name;
      }
    }
  const auto tree = parse_xml(draw(small_figure("<a> & b"), Format::kSvg));
  EXPECT_EQ(tree.get<std::string>("svg.title"), "<a> & b");
}

TEST(FigureFile, TheEndingChoosesTheFormat) {
  const stillpoint::testing::TemporaryFolder folder;
  const std::pair<const char*, const char*> beginnings[] = {
      {"a.png", "\x89PNG"}, {"new/a.svg", "<?xml"}, {"a.b.pdf", "%PDF"}};
  for (const auto& [name, beginning] : beginnings) {
    write_figure(small_figure("Errors"), folder.path() / name);
    std::ifstream file(folder.path() / name, std::ios::binary);
    std::string bytes(4, ' ');
    file.read(bytes.data(), 4);
    EXPECT_THAT(std::string(beginning), StartsWith(bytes));
  }
}

TEST(FigureFile, AnotherEndingIsAnErrorThatNamesTheThree) {
  for (const char* name : {"plot.jpg", "plot", "png", "plot.svg.gz", ""}) {
    try {
      format_of(name);
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), Fault::kUsage);
      EXPECT_THAT(error.what(), HasSubstr(".png, .svg or .pdf"));
    }
  }
}

TEST(FigureFile, AFileThatCannotBeWrittenIsAnError) {
  const stillpoint::testing::TemporaryFolder folder;
  folder.write("file", "");
  EXPECT_THROW(write_figure(small_figure("Errors"), folder.path() / "file/plot.png"), Error);
}

}  // namespace
}  // namespace stillpoint::figures
