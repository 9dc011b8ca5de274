#include "stillpoint/support/image_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "support/error_text.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Bytes = std::vector<std::uint8_t>;

Bytes encoded(const std::string& extension, cv::Size size, const std::vector<int>& options = {}) {
  cv::Mat image(size, CV_8UC3);
  cv::randu(image, 0, 256);
  return encode_image(extension, image, options);
}

std::string refusal_of(const Bytes& file) {
  return testing::error_text(Fault::kData, [&] { require_image_size(file, "image 7"); });
}

void expect_size(const Bytes& file, cv::Size size) {
  const auto stated = stated_image_size(file);
  ASSERT_TRUE(stated);
  EXPECT_EQ(*stated, size);
}

TEST(ImageFile, KindsStateTheirSize) {
  const cv::Size size(317, 243);
  for (const char* extension : {".png", ".jpg", ".bmp", ".ppm"}) {
    SCOPED_TRACE(extension);
    expect_size(encoded(extension, size), size);
  }
  expect_size(encoded(".webp", size, {cv::IMWRITE_WEBP_QUALITY, 60}), size);
  expect_size(encoded(".webp", size, {cv::IMWRITE_WEBP_QUALITY, 101}), size);  // without loss
  expect_size(encoded(".jpg", size, {cv::IMWRITE_JPEG_PROGRESSIVE, 1}), size);
}

TEST(ImageFile, TextAndCommentsBeforeTheSizeOfAPnm) {
  const std::string text = "P5 # 9999\n# 1 2\n 640\t480 65535\n";
  expect_size(Bytes(text.begin(), text.end()), {640, 480});
}

// What OpenCV decodes is what was stated, also where a comment or a number ends oddly.
TEST(ImageFile, PnmCannotHideItsSize) {
  for (const std::string text : {"P5 #x\r60 40\r255\n#1\n1 1 255\n", "P5 60#40 255\n1 \n 9 255\n",
                                 "P5 60 40#1 1\n 255 ", "P5\n60 40 255\n"}) {
    Bytes file(text.begin(), text.end());
    file.resize(file.size() + 60 * 1255, 7);
    const cv::Mat image = decode_image(file, cv::IMREAD_UNCHANGED);
    SCOPED_TRACE(text);
    const auto stated = stated_image_size(file);
    if (image.empty()) continue;  // refused by OpenCV
    ASSERT_TRUE(stated);
    EXPECT_EQ(*stated, image.size());
  }
}

// A decoder skips what is no marker, and markers without a length.
TEST(ImageFile, JpegCannotHideItsSize) {
  const cv::Size size(317, 243);
  for (const Bytes& junk : {Bytes{0, 1, 2}, Bytes{0xff, 0x01}, Bytes{0xff, 0xff, 0xff},
                            Bytes{0xff, 0x00}, Bytes{0xff, 0xd3, 7}}) {
    Bytes file = encoded(".jpg", size);
    file.insert(file.begin() + 20, junk.begin(), junk.end());  // behind the segment of JFIF
    expect_size(file, size);
  }
}

TEST(ImageFile, RefusesImagesThatNoCameraGives) {
  Bytes png = encoded(".png", {32, 32});
  png[16] = 0x7f;  // a width of two thousand millions
  EXPECT_THAT(refusal_of(png),
              AllOf(HasSubstr("image 7"), HasSubstr("more than any camera gives")));
  Bytes bmp = encoded(".bmp", {32, 32});
  bmp[21] = 0x80;  // -2^31 + 32
  EXPECT_THAT(refusal_of(bmp), HasSubstr("2147483616 x 32"));
  Bytes jpeg = encoded(".jpg", {32, 32});
  const Bytes frame_header = {0xff, 0xc0};  // then length (2), bits (1), height (2), width (2)
  const auto header = std::ranges::search(jpeg, frame_header).begin();
  ASSERT_NE(header, jpeg.end());
  std::ranges::copy(Bytes{0x7d, 0x00, 0x7d, 0x00}, header + 5);
  EXPECT_THAT(refusal_of(jpeg), HasSubstr("32000 x 32000"));
  const std::string pnm = "P6 99999999999999999999 1 255\n";
  EXPECT_THAT(refusal_of(Bytes(pnm.begin(), pnm.end())), HasSubstr("2147483647 x 1"));
}

TEST(ImageFile, RefusesWhatDoesNotStateItsSize) {
  const Bytes jpeg = encoded(".jpg", {32, 32});
  for (const Bytes& file :
       {Bytes{}, Bytes{'B', 'M'}, Bytes{'P', '5', ' ', '6'}, Bytes{0x89, 'P', 'N', 'G'},
        Bytes(jpeg.begin(), jpeg.begin() + 30), encoded(".tiff", {32, 32})})
    EXPECT_THAT(refusal_of(file), HasSubstr("is not an image that can be read"));
}

TEST(ImageFile, ReadsRegularFilesOnly) {
  const testing::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.png";
  const auto text = [&] {
    return testing::error_text(Fault::kData, [&] { read_image_file(file); });
  };
  EXPECT_THAT(text(), HasSubstr("no such file"));
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(text(), HasSubstr("is no regular file"));
  fs::remove(file);
  fs::create_symlink("/dev/zero", file);
  EXPECT_THAT(text(), HasSubstr("is no regular file"));
  fs::remove(file);
  folder.write("a.png", "");
  EXPECT_THAT(text(), HasSubstr("the file is empty"));
  fs::resize_file(file, 20'000'000'000);  // sparse
  EXPECT_THAT(text(), HasSubstr("such a file has at most 256"));
}

}  // namespace
}  // namespace stillpoint
