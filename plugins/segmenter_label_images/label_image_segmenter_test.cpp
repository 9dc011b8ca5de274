#include "segmenter_label_images/label_image_segmenter.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <filesystem>
#include <functional>
#include <opencv2/imgproc.hpp>

#include "support/error_text.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::segmenter_label_images {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing::stamp_text;
using testing::TemporaryFolder;

constexpr int kPerson = 15;
constexpr int kChair = 9;
const cv::Size kSize(160, 120);
const cv::Rect kPersonBox(20, 30, 40, 60);
const cv::Rect kChairBox(100, 50, 30, 30);

cv::Mat room_labels() {
  cv::Mat labels(kSize, CV_8UC1, cv::Scalar(0));
  labels(kPersonBox).setTo(kPerson);
  labels(kChairBox).setTo(kChair);
  return labels;
}

Frame frame_at(double time, std::uint32_t index = 0, cv::Size size = kSize) {
  return {.index = index, .time = time, .gray = cv::Mat(size, CV_8UC1, cv::Scalar(0))};
}

int count(const cv::Mat& labels, int label) { return cv::countNonZero(labels == label); }

class LabelImageSegmenterTest : public ::testing::Test {
 protected:
  std::filesystem::path write(double time, const cv::Mat& image) const {
    const auto file = folder_.path() / "labels" / (stamp_text(time) + ".png");
    std::filesystem::create_directories(file.parent_path());
    testing::write_image(file, image);
    return file;
  }
  LabelImageSegmenter open(std::uint64_t seed = 1) const {
    StageContext context{.seed = seed, .recording = folder_.path()};
    return {options_, context};
  }
  static std::string message_of(const std::function<void()>& action, Fault fault = Fault::kData) {
    return testing::error_text(fault, action);
  }

  TemporaryFolder folder_;
  LabelImageSegmenter::Options options_;
};

TEST_F(LabelImageSegmenterTest, GivesLabelsAndObjectsOfTheFrame) {
  write(1.0, room_labels());
  write(2.0, cv::Mat(kSize, CV_8UC1, cv::Scalar(0)));
  LabelImageSegmenter segmenter = open();
  EXPECT_EQ(segmenter.classes()[kPerson], "person");
  const Segmentation labels = segmenter.segment(frame_at(1.0004, 7));
  EXPECT_EQ(labels.frame, 7U);
  EXPECT_EQ(cv::norm(labels.labels, room_labels(), cv::NORM_INF), 0);
  ASSERT_EQ(labels.objects.size(), 2U);
  EXPECT_EQ(labels.objects[0].label, kPerson);
  EXPECT_EQ(labels.objects[0].box, kPersonBox);
  EXPECT_EQ(labels.objects[1].pixels, kChairBox.area());
  const Segmentation nothing = segmenter.segment(frame_at(2.0, 8));
  EXPECT_TRUE(nothing.known());
  EXPECT_TRUE(nothing.objects.empty());
}

TEST_F(LabelImageSegmenterTest, VoidAndSmallObjectsAreBackground) {
  cv::Mat image = room_labels();
  image(cv::Rect(0, 0, 30, 10)).setTo(255);
  image(cv::Rect(140, 100, 9, 9)).setTo(kChair);
  write(1.0, image);
  const Segmentation labels = open().segment(frame_at(1.0));
  EXPECT_EQ(cv::norm(labels.labels, room_labels(), cv::NORM_INF), 0);
}

TEST_F(LabelImageSegmenterTest, ClassesAreNamedOrListed) {
  write(1.0, cv::Mat(kSize, CV_8UC1, cv::Scalar(1)));
  options_.classes = {"background", "person"};
  EXPECT_EQ(open().classes(), (ClassNames{"background", "person"}));
  options_.classes = {"coco80"};
  EXPECT_EQ(open().classes().size(), 81U);
  options_.classes = {"voc12"};
  EXPECT_THAT(message_of([&] { open(); }, Fault::kUsage), HasSubstr("did you mean 'voc21'?"));
  options_.classes = {"background", "", "person"};
  EXPECT_THAT(message_of([&] { open(); }, Fault::kUsage), HasSubstr("class without a name"));
}

TEST_F(LabelImageSegmenterTest, MissesAsOftenAsAsked) {
  write(1.0, room_labels());
  options_.errors.miss_rate = 0.25;
  LabelImageSegmenter segmenter = open();
  int persons = 0;
  int both = 0;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const Segmentation labels = segmenter.segment(frame_at(1.0, i));
    persons += count(labels.labels, kPerson) > 0;
    both += labels.objects.size() == 2;
  }
  EXPECT_NEAR(persons, 300, 30);
  EXPECT_NEAR(both, 225, 35);  // independent of each other
}

TEST_F(LabelImageSegmenterTest, ErrorsLastAsLongAsAsked) {
  write(1.0, room_labels());
  options_.errors.miss_rate = 0.5;
  options_.errors.error_frames = 4;
  LabelImageSegmenter segmenter = open();
  int changes = 0;
  bool before = false;
  for (std::uint32_t i = 0; i < 400; ++i) {
    const bool seen = count(segmenter.segment(frame_at(1.0, i)).labels, kPerson) > 0;
    if (seen != before && i > 0) {
      EXPECT_EQ(i % 4, 0U);
      ++changes;
    }
    before = seen;
  }
  EXPECT_NEAR(changes, 50, 20);
}

TEST_F(LabelImageSegmenterTest, LegsHolesAndFloorAsAsked) {
  write(1.0, room_labels());
  options_.errors.missing_lower_part = 0.5;
  EXPECT_EQ(open().segment(frame_at(1.0)).objects[0].box,
            cv::Rect(kPersonBox.x, kPersonBox.y, kPersonBox.width, kPersonBox.height / 2));
  options_.errors.missing_lower_part = 0;
  options_.errors.floor = 2;
  EXPECT_EQ(open().segment(frame_at(1.0)).objects[0].box,
            cv::Rect(kPersonBox.x - kPersonBox.width / 2, kPersonBox.y, 2 * kPersonBox.width,
                     kPersonBox.height));
  options_.errors.floor = 0;
  options_.errors.holes = 12;
  LabelImageSegmenter segmenter = open();
  const cv::Mat first = segmenter.segment(frame_at(1.0, 0)).labels;
  EXPECT_LT(count(first, kPerson), 0.95 * kPersonBox.area());
  EXPECT_GT(count(first, kPerson), 0.6 * kPersonBox.area());
  EXPECT_EQ(cv::norm(first, segmenter.segment(frame_at(1.0, 0)).labels, cv::NORM_INF), 0);
  EXPECT_GT(cv::norm(first, segmenter.segment(frame_at(1.0, 1)).labels, cv::NORM_INF), 0);
}

TEST_F(LabelImageSegmenterTest, OutlinesMoveByPixels) {
  write(1.0, room_labels());
  options_.errors.boundary = -3;
  cv::Rect smaller(kPersonBox.tl() + cv::Point(3, 3), kPersonBox.size() - cv::Size(6, 6));
  EXPECT_EQ(open().segment(frame_at(1.0)).objects[0].box, smaller);
  EXPECT_EQ(open().segment(frame_at(1.0)).objects[0].pixels, smaller.area());
  options_.errors.boundary = 3;
  cv::Rect larger(kPersonBox.tl() - cv::Point(3, 3), kPersonBox.size() + cv::Size(6, 6));
  EXPECT_EQ(open().segment(frame_at(1.0)).objects[0].box, larger);
}

TEST_F(LabelImageSegmenterTest, OutlineErrorsStayWithinBounds) {
  write(1.0, room_labels());
  options_.errors.outline_error = 4;
  LabelImageSegmenter segmenter = open();
  cv::Mat inner, outer;
  const cv::Mat person = room_labels() == kPerson;
  const cv::Mat disc = cv::getStructuringElement(cv::MORPH_RECT, {9, 9});
  cv::erode(person, inner, disc);
  cv::dilate(person, outer, disc);
  int farthest = 0;
  for (std::uint32_t i = 0; i < 10; ++i) {
    const cv::Mat seen = segmenter.segment(frame_at(1.0, i)).labels == kPerson;
    EXPECT_EQ(cv::countNonZero(inner & ~seen), 0);
    EXPECT_EQ(cv::countNonZero(seen & ~outer), 0);
    farthest = std::max(farthest, cv::countNonZero(seen != person));
  }
  EXPECT_GT(farthest, 100);
}

TEST_F(LabelImageSegmenterTest, AddsObjectsThatAreNotThere) {
  write(1.0, cv::Mat(kSize, CV_8UC1, cv::Scalar(0)));
  options_.errors.false_objects = 0.3;
  options_.errors.false_class = "chair";
  LabelImageSegmenter segmenter = open();
  int frames = 0;
  for (std::uint32_t i = 0; i < 200; ++i)
    frames += count(segmenter.segment(frame_at(1.0, i)).labels, kChair) > 0;
  EXPECT_NEAR(frames, 60, 20);
  options_.errors.false_class = "chiar";
  EXPECT_THAT(message_of([&] { open(); }, Fault::kUsage), HasSubstr("did you mean 'chair'?"));
}

TEST_F(LabelImageSegmenterTest, ErrorsDependOnSeedAndFrameOnly) {
  write(1.0, room_labels());
  options_.errors = {.miss_rate = 0.5, .outline_error = 3, .false_objects = 0.5};
  LabelImageSegmenter forwards = open();
  LabelImageSegmenter backwards = open();
  LabelImageSegmenter other = open(2);
  std::vector<cv::Mat> first(20), second(20);
  int equal = 0;
  for (std::uint32_t i = 0; i < 20; ++i) {
    first[i] = forwards.segment(frame_at(1.0, i)).labels;
    second[19 - i] = backwards.segment(frame_at(1.0, 19 - i)).labels;
    equal += cv::norm(first[i], other.segment(frame_at(1.0, i)).labels, cv::NORM_INF) == 0;
  }
  for (std::size_t i = 0; i < 20; ++i) EXPECT_EQ(cv::norm(first[i], second[i], cv::NORM_INF), 0);
  EXPECT_LT(equal, 5);
}

TEST_F(LabelImageSegmenterTest, EverythingOrNobodyIsAPerson) {
  using Kind = AdversarialOptions::Kind;
  write(1.0, room_labels());
  options_.adversarial.adversarial = Kind::kEverything;
  const Segmentation everything = open().segment(frame_at(1.0));
  EXPECT_EQ(count(everything.labels, kPerson), kSize.area());
  ASSERT_EQ(everything.objects.size(), 1U);
  EXPECT_EQ(everything.objects[0].pixels, kSize.area());
  options_.adversarial.adversarial = Kind::kNobody;
  const Segmentation nobody = open().segment(frame_at(1.0));
  EXPECT_TRUE(nobody.known());
  EXPECT_EQ(cv::countNonZero(nobody.labels), 0);
}

TEST_F(LabelImageSegmenterTest, BlobsAreAnywhereAndLastAsLongAsAsked) {
  write(1.0, room_labels());
  options_.adversarial.adversarial = AdversarialOptions::Kind::kBlobs;
  options_.errors.error_frames = 3;
  LabelImageSegmenter segmenter = open();
  cv::Mat before;
  double covered = 0;
  for (std::uint32_t i = 0; i < 60; ++i) {
    const cv::Mat labels = segmenter.segment(frame_at(1.0, i)).labels;
    covered += count(labels, kPerson) / 60.0 / kSize.area();
    EXPECT_EQ(count(labels, kChair), 0);
    if (i == 0) before = labels;
    EXPECT_EQ(cv::norm(labels, before, cv::NORM_INF) > 0, i > 0 && i % 3 == 0) << i;
    before = labels;
  }
  EXPECT_NEAR(covered, 0.3, 0.1);
}

TEST_F(LabelImageSegmenterTest, StaticThingsAreTakenForPeople) {
  write(1.0, room_labels());
  options_.adversarial.mistaken = {"chair"};
  const Segmentation labels = open().segment(frame_at(1.0));
  EXPECT_EQ(count(labels.labels, kPerson), kPersonBox.area() + kChairBox.area());
  EXPECT_EQ(count(labels.labels, kChair), 0);
  options_.adversarial.mistaken = {"chiar"};
  EXPECT_THAT(message_of([&] { open(); }, Fault::kUsage), HasSubstr("did you mean 'chair'?"));
}

TEST_F(LabelImageSegmenterTest, LabelsAreLate) {
  for (int i = 0; i < 5; ++i) {
    cv::Mat labels(kSize, CV_8UC1, cv::Scalar(0));
    labels(cv::Rect(20 * i, 10, 20, 20)).setTo(kPerson);
    write(1.0 + i, labels);
  }
  options_.adversarial.late = 2;
  LabelImageSegmenter segmenter = open();
  EXPECT_EQ(segmenter.segment(frame_at(5.0, 4)).objects[0].box.x, 40);
  EXPECT_EQ(segmenter.segment(frame_at(3.0, 2)).objects[0].box.x, 0);
  EXPECT_EQ(segmenter.segment(frame_at(2.0, 1)).objects[0].box.x, 0);  // nothing is older
  EXPECT_FALSE(segmenter.segment(frame_at(2.5, 1)).known());
}

TEST_F(LabelImageSegmenterTest, AFrameWithoutImageHasNoLabels) {
  write(1.0, room_labels());
  LabelImageSegmenter segmenter = open();
  EXPECT_TRUE(segmenter.segment(frame_at(1.0)).known());
  for (std::uint32_t i = 0; i < 30; ++i)
    EXPECT_FALSE(segmenter.segment(frame_at(2.0 + i, i)).known());
}

TEST_F(LabelImageSegmenterTest, LabelsOfAnotherRecordingAreFoundOut) {
  write(1.0, room_labels());
  LabelImageSegmenter segmenter = open();
  for (std::uint32_t i = 0; i < 9; ++i)
    EXPECT_FALSE(segmenter.segment(frame_at(50.0 + i, i)).known());
  EXPECT_THAT(message_of([&] { segmenter.segment(frame_at(60.5, 9)); }),
              AllOf(HasSubstr("59.500000 s away"), HasSubstr("none of the first frames"),
                    HasSubstr("labels of this recording?")));
}

TEST_F(LabelImageSegmenterTest, BadFoldersAreFoundOutAtTheStart) {
  EXPECT_THAT(message_of([&] { open(); }), AllOf(HasSubstr("labels: "), HasSubstr("'path'")));
  folder_.write("labels/readme.png", "not an image");
  EXPECT_THAT(message_of([&] { open(); }),
              AllOf(HasSubstr("no label images"), HasSubstr("1305031102.175304.png")));
  EXPECT_THAT(message_of([&] { LabelImageSegmenter(options_, {}); }, Fault::kUsage),
              HasSubstr("no folder of label images is given"));
}

TEST_F(LabelImageSegmenterTest, BadImagesAreFoundOutAtTheStart) {
  const auto file = write(1.0, cv::Mat(kSize, CV_8UC3, cv::Scalar(15, 15, 15)));
  EXPECT_THAT(message_of([&] { open(); }),
              AllOf(HasSubstr("1.000000.png"), HasSubstr("8-bit colour"),
                    HasSubstr("one class id per pixel")));
  write(1.0, cv::Mat(kSize, CV_16UC1, cv::Scalar(15)));
  EXPECT_THAT(message_of([&] { open(); }), HasSubstr("16-bit gray"));
  write(1.0, cv::Mat(kSize, CV_8UC1, cv::Scalar(21)));
  EXPECT_THAT(message_of([&] { open(); }),
              AllOf(HasSubstr("class id 21, but there are 21 classes"), HasSubstr("'classes'")));
  testing::truncate_file(file, 0.0);
  EXPECT_THAT(message_of([&] { open(); }), HasSubstr("the file is empty"));
  folder_.write("labels/1.000000.png", "not an image");
  EXPECT_THAT(message_of([&] { open(); }), HasSubstr("is not an image that can be read"));
  std::filesystem::remove(file);
  ASSERT_EQ(::mkfifo(file.c_str(), 0600), 0);
  EXPECT_THAT(message_of([&] { open(); }), HasSubstr("is no regular file"));
}

TEST_F(LabelImageSegmenterTest, LabelsOfAnotherSizeThanTheCameraAreFoundOutAtTheStart) {
  write(1.0, room_labels());
  StageContext context{.recording = folder_.path()};
  context.camera = CameraModel{.width = 200, .height = 120, .crop = {20, 0, 160, 120}};
  EXPECT_NO_THROW(LabelImageSegmenter(options_, context));
  context.camera->crop.clear();
  EXPECT_THAT(message_of([&] { LabelImageSegmenter(options_, context); }),
              AllOf(HasSubstr("1.000000.png"), HasSubstr("160 x 120"), HasSubstr("200 x 120")));
}

TEST_F(LabelImageSegmenterTest, LabelsOfAnotherSizeAreAnError) {
  write(1.0, room_labels());
  LabelImageSegmenter segmenter = open();
  EXPECT_THAT(message_of([&] {
                segmenter.segment(frame_at(1.0, 0, {80, 60}));
              }),
              AllOf(HasSubstr("160 x 120"), HasSubstr("80 x 60"), HasSubstr("undistorted")));
}

}  // namespace
}  // namespace stillpoint::segmenter_label_images
