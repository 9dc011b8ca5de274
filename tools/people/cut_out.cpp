#include "people/cut_out.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {
namespace {

constexpr int kHeight = 960;       // px that a cut-out has at least
constexpr double kRelief = 0.07;   // heights of a person from the outline to the front
constexpr double kRounded = 0.05;  // heights from the outline inwards over which it rises

cv::Mat three(const cv::Mat& channel) {
  cv::Mat result;
  cv::merge(std::vector<cv::Mat>(3, channel), result);
  return result;
}

/// Outside of `inside` (CV_8U) every colour becomes that of the person nearby.
void spread_colours(cv::Mat& bgr, const cv::Mat& inside) {
  cv::Mat weight;
  inside.convertTo(weight, CV_32F, 1.0 / 255);
  const cv::Mat own = bgr.mul(three(weight));
  cv::Mat known = inside.clone();
  for (const int reach : {7, 31}) {
    cv::Mat sum, weights;
    cv::blur(own, sum, {reach, reach});
    cv::blur(weight, weights, {reach, reach});
    const cv::Mat fresh = (weights > 1e-4) & (known == 0);
    cv::Mat mean = sum / three(cv::max(weights, 1e-4));
    mean.copyTo(bgr, fresh);
    known |= fresh;
  }
}

/// Weave and pores, stronger where it is bright.
void add_grain(cv::Mat& bgr, double enlargement, int seed) {
  if (enlargement < 1.2) return;
  cv::RNG random(static_cast<std::uint64_t>(seed) * 7919 + 3);
  cv::Mat grain = cv::Mat::zeros(bgr.size(), CV_32F);
  for (const double size : {1.6, 3.2}) {  // px
    cv::Mat coarse(cvCeil(bgr.rows / size), cvCeil(bgr.cols / size), CV_32F), fine;
    random.fill(coarse, cv::RNG::NORMAL, 0, 0.022);
    cv::resize(coarse, fine, bgr.size(), 0, 0, cv::INTER_CUBIC);
    grain += fine;
  }
  bgr += three(grain).mul(bgr + cv::Scalar::all(12));
}

double highlights_of(const cv::Mat& photo, const cv::Mat& mask) {
  cv::Mat gray, counts;
  cv::cvtColor(photo, gray, cv::COLOR_BGR2GRAY);
  const float range[] = {0, 256};
  const float* ranges = range;
  const int bins = 256, channel = 0;
  cv::calcHist(&gray, 1, &channel, mask, counts, 1, &bins, &ranges);
  double left = 0.1 * cv::countNonZero(mask);
  int value = 255;
  while (value > 0 && (left -= counts.at<float>(value)) > 0) --value;
  return value;
}

cv::Mat relief_of(const cv::Mat& mask) {
  cv::Mat relief;
  cv::distanceTransform(mask, relief, cv::DIST_L2, cv::DIST_MASK_5);
  cv::sqrt(cv::min(relief / (kRounded * mask.rows), 1.0), relief);
  return kRelief * relief;
}

}  // namespace

CutOut cut_out(const cv::Mat& photo, const cv::Mat& mask, int seed) {
  const cv::Rect box = cv::boundingRect(mask);
  const double enlargement = std::max(1.0, static_cast<double>(kHeight) / box.height);
  CutOut person{.light = cv::mean(photo, mask == 0), .highlights = highlights_of(photo, mask)};
  cv::Mat bgr, drawn, inner;
  cv::resize(photo(box), bgr, {}, enlargement, enlargement, cv::INTER_LANCZOS4);
  cv::resize(mask(box), drawn, bgr.size(), 0, 0, cv::INTER_CUBIC);
  cv::GaussianBlur(drawn, drawn, {}, 0.7 * enlargement);
  drawn = drawn > 127;
  // Outlines drawn by hand take in a seam of the background.
  const int seam = std::max(1, cvRound(1.2 * enlargement));
  cv::copyMakeBorder(drawn, drawn, seam, seam, seam, seam, cv::BORDER_CONSTANT, 0);
  cv::erode(drawn, inner,
            cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * seam + 1, 2 * seam + 1}));
  inner = inner(cv::Rect({seam, seam}, bgr.size())).clone();
  bgr.convertTo(person.bgr, CV_32F);
  spread_colours(person.bgr, inner);
  add_grain(person.bgr, enlargement, seed);
  inner.convertTo(person.alpha, CV_32F, 1.0 / 255);
  cv::GaussianBlur(person.alpha, person.alpha, {}, 0.5 * enlargement);
  person.relief = relief_of(inner);
  return person;
}

std::vector<CutOut> levels_of(CutOut cut) {
  std::vector<CutOut> levels = {std::move(cut)};
  while (levels.back().alpha.rows > 60) {
    const CutOut& above = levels.back();
    CutOut half{.light = above.light, .highlights = above.highlights};
    cv::resize(above.bgr, half.bgr, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::resize(above.alpha, half.alpha, {}, 0.5, 0.5, cv::INTER_AREA);
    cv::resize(above.relief, half.relief, {}, 0.5, 0.5, cv::INTER_AREA);
    levels.push_back(std::move(half));
  }
  return levels;
}

}  // namespace stillpoint::people
