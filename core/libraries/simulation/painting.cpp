#include "simulation/painting.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <string>

namespace stillpoint::simulation {

cv::Mat Painter::noise(cv::Size size, cv::Size coarsest_cells, int octaves, double persistence) {
  constexpr int kPad = 2;  // cells around, copied from the other side, so that the result repeats
  cv::Mat sum = cv::Mat::zeros(size, CV_32F);
  double amplitude = 1;
  cv::Size cells = coarsest_cells;
  for (int i = 0; i < octaves; ++i, amplitude *= persistence, cells *= 2) {
    cells = {std::min(cells.width, size.width), std::min(cells.height, size.height)};
    cv::Mat lattice(cells, CV_32F);
    random_.fill(lattice, cv::RNG::UNIFORM, -1, 1);
    cv::Mat padded;
    cv::copyMakeBorder(lattice, padded, kPad, kPad, kPad, kPad, cv::BORDER_WRAP);
    const double fx = static_cast<double>(size.width) / cells.width;
    const double fy = static_cast<double>(size.height) / cells.height;
    cv::Mat fine;
    cv::resize(padded, fine, cv::Size(cvRound(padded.cols * fx), cvRound(padded.rows * fy)), 0, 0,
               cv::INTER_CUBIC);
    sum += amplitude * fine(cv::Rect({cvRound(kPad * fx), cvRound(kPad * fy)}, size));
  }
  return sum;
}

cv::Mat Painter::tint(const cv::Mat& field, cv::Scalar base, double contrast) {
  cv::Mat image(field.size(), CV_8UC3);
  for (int y = 0; y < field.rows; ++y) {
    for (int x = 0; x < field.cols; ++x) {
      const double gain = 1 + contrast * field.at<float>(y, x);
      for (int c = 0; c < 3; ++c)
        image.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(base[c] * gain);
    }
  }
  return image;
}

cv::Scalar Painter::color(int low, int high) {
  return {double(uniform(low, high)), double(uniform(low, high)), double(uniform(low, high))};
}

void Painter::write_lines(cv::Mat& image, cv::Rect area, double height, cv::Scalar ink) {
  const double scale = height / 22;  // of Hershey fonts, whose capitals are about 22 px high
  for (double y = area.y + height; y < area.br().y; y += 1.7 * height) {
    std::string line;
    const int letters = static_cast<int>(area.width / (0.95 * height)) - uniform(0, 6);
    for (int i = 0; i < letters; ++i)
      line += uniform(0, 6) == 0 ? ' ' : static_cast<char>('a' + uniform(0, 26));
    cv::putText(image, line, {area.x, static_cast<int>(y)}, cv::FONT_HERSHEY_SIMPLEX, scale, ink,
                std::max(1, static_cast<int>(height / 9)), cv::LINE_AA);
  }
}

void Painter::picture(cv::Mat image) {
  tint(noise(image.size(), {3, 3}, 6, 0.6), color(60, 220), 0.35).copyTo(image);
  const int shapes = uniform(8, 22);
  for (int i = 0; i < shapes; ++i) {
    const cv::Point centre(uniform(0, image.cols), uniform(0, image.rows));
    const int size = uniform(2, std::max(3, std::min(image.cols, image.rows) / 4));
    const int kind = uniform(0, 3);
    if (kind == 0) {
      cv::ellipse(image, centre, {size, size * uniform(4, 11) / 10 + 1}, uniform(0, 180), 0, 360,
                  color(), cv::FILLED, cv::LINE_AA);
    } else if (kind == 1) {
      const cv::Point corner = centre + cv::Point(size, size * uniform(5, 15) / 10);
      cv::rectangle(image, centre, corner, color(), cv::FILLED, cv::LINE_AA);
    } else {
      std::vector<cv::Point> corners;
      for (int k = 0; k < 3; ++k)
        corners.push_back(centre + cv::Point(uniform(-size, size + 1), uniform(-size, size + 1)));
      cv::fillConvexPoly(image, corners, color(), cv::LINE_AA);
    }
  }
}

cv::Mat Painter::plaster(cv::Size size, cv::Scalar base, double contrast) {
  if (album_) return album_->many(size, 3, random_);
  const cv::Mat field = noise(size, {24, 16}, 6, 0.8);
  return tint(field, base, contrast);
}

cv::Mat Painter::wood(cv::Size size, cv::Scalar base, double contrast) {
  if (album_) return album_->many(size, 2, random_);
  const cv::Mat grain = noise(size, {2, 24}, 5, 0.7);
  const cv::Mat pores = noise(size, {size.width / 32, size.height / 4}, 2, 0.6);
  return tint(0.7 * grain + 0.5 * pores, base, contrast);
}

cv::Mat Painter::carpet(cv::Size size) {
  if (album_) return album_->many(size, 4, random_);
  cv::Mat field = noise(size, {6, 6}, 9, 0.78);
  cv::Mat image = tint(field, {118, 112, 108}, 0.16);
  const int specks = size.area() / 900;
  for (int i = 0; i < specks; ++i) {
    const cv::Point at(uniform(0, size.width), uniform(0, size.height));
    const double grey = uniform(0, 2) == 0 ? uniform(40, 80) : uniform(150, 200);
    cv::circle(image, at, uniform(1, 4), {grey, grey, grey * 0.95}, cv::FILLED, cv::LINE_AA);
  }
  return image;
}

cv::Mat Painter::poster(cv::Size size) {
  if (album_) return album_->one(size, random_);
  cv::Mat image = tint(noise(size, {2, 3}, 4), color(150, 245), 0.08);
  const int margin = size.width / 20;
  const cv::Scalar dark = color(10, 90);
  const cv::Rect header(margin, margin, size.width - 2 * margin, size.height / 8);
  cv::rectangle(image, header, color(20, 160), cv::FILLED);
  write_lines(image, header - cv::Point(-8, -4), header.height * 0.35, {240, 240, 240});
  const int rows = uniform(2, 4);
  const int top = header.br().y + margin;
  const int row_height = (size.height - top - margin) / rows;
  for (int row = 0; row < rows; ++row) {
    const int split = uniform(35, 66);
    const int y = top + row * row_height;
    const int width = size.width - 2 * margin;
    const cv::Rect left(margin, y, width * split / 100 - margin / 2, row_height - margin);
    const cv::Rect right(left.br().x + margin, y, margin + width - left.br().x - margin,
                         row_height - margin);
    const bool picture_left = uniform(0, 2) == 0;
    picture(image(picture_left ? left : right));
    write_lines(image, picture_left ? right : left, uniform(9, 20), dark);
  }
  cv::rectangle(image, cv::Rect({0, 0}, size), dark, 3);
  return image;
}

cv::Mat Painter::paper(cv::Size size) {
  cv::Mat image = tint(noise(size, {3, 3}, 3), {236, 240, 240}, 0.03);
  const int margin = size.width / 10;
  const cv::Scalar ink(45, 40, 40);
  write_lines(image, {margin, margin, size.width - 2 * margin, size.height / 2 - margin},
              size.width / 34.0, ink);
  if (uniform(0, 2) == 0) {
    picture(image(cv::Rect(margin, size.height / 2, size.width / 2, size.height / 3)));
  } else {
    write_lines(image, {margin, size.height / 2, size.width - 2 * margin, size.height / 3},
                size.width / 28.0, ink);
  }
  return image;
}

cv::Mat Painter::whiteboard(cv::Size size) {
  if (album_) return album_->one(size, random_);
  cv::Mat image = tint(noise(size, {4, 3}, 4), {228, 230, 230}, 0.03);
  const std::array<cv::Scalar, 4> pens = {
      {{160, 60, 30}, {40, 40, 40}, {50, 40, 170}, {60, 120, 30}}};
  for (int i = 0; i < 16; ++i) {
    const cv::Scalar& pen = pens[static_cast<std::size_t>(uniform(0, 4))];
    const cv::Point at(uniform(20, size.width - 200), uniform(20, size.height - 150));
    if (i % 3 == 0) {
      cv::ellipse(image, at + cv::Point(80, 60), {uniform(30, 90), uniform(20, 60)}, 0, 0, 360, pen,
                  3, cv::LINE_AA);
    } else if (i % 3 == 1) {
      write_lines(image, {at.x, at.y, uniform(120, 300), uniform(40, 120)}, uniform(14, 26), pen);
    } else {
      cv::arrowedLine(image, at, at + cv::Point(uniform(-150, 150), uniform(-90, 90)), pen, 3,
                      cv::LINE_AA);
    }
  }
  return image;
}

cv::Mat Painter::books(cv::Size size) {
  if (album_) return album_->one(size, random_);
  cv::Mat image(size, CV_8UC3, cv::Scalar(38, 42, 46));
  for (int x = 2; x < size.width - 8;) {
    const int width = std::min(uniform(14, 46), size.width - 2 - x);
    const int height = size.height * uniform(68, 97) / 100;
    const cv::Rect spine(x, size.height - height, width, height);
    const cv::Scalar base = color(25, 225);
    tint(noise(spine.size(), {1, 4}, 4), base, 0.12).copyTo(image(spine));
    cv::rectangle(image, spine, base * 0.45, 1);
    const bool light = base[0] + base[1] + base[2] < 380;
    const cv::Scalar ink = light ? cv::Scalar(225, 230, 230) : cv::Scalar(30, 30, 35);
    cv::Mat label(cv::Size(height, width), CV_8UC3);
    cv::rotate(image(spine), label, cv::ROTATE_90_COUNTERCLOCKWISE);
    write_lines(label, {height / 12, width / 6, height * 8 / 10, std::max(10, width / 2)},
                std::clamp(width * 0.4, 7.0, 16.0), ink);
    cv::Mat upright;
    cv::rotate(label, upright, cv::ROTATE_90_CLOCKWISE);
    upright.copyTo(image(spine));
    for (int band = uniform(0, 3); band > 0; --band) {
      const int y = spine.y + uniform(0, height - 8);
      cv::rectangle(image, cv::Rect(x, y, width, uniform(3, 8)), color(), cv::FILLED);
    }
    x += width + (uniform(0, 9) == 0 ? uniform(10, 40) : 0);
  }
  return image;
}

cv::Mat Painter::keyboard(cv::Size size) {
  cv::Mat image(size, CV_8UC3, cv::Scalar(24, 24, 24));
  const int pitch = size.height / 6;
  for (int y = pitch / 2; y + pitch < size.height; y += pitch) {
    for (int x = pitch / 2; x + pitch < size.width; x += pitch) {
      const cv::Rect key(x, y, pitch - 3, pitch - 3);
      cv::rectangle(image, key, cv::Scalar::all(uniform(48, 62)), cv::FILLED);
      write_lines(image, {x + 2, y + 1, pitch, pitch / 2}, pitch * 0.4, cv::Scalar::all(200));
    }
  }
  return image;
}

cv::Mat Painter::screen(cv::Size size, bool on) {
  if (album_ && on) return album_->one(size, random_);
  cv::Mat image = tint(noise(size, {3, 2}, 3), {26, 24, 22}, on ? 0.1 : 0.35);
  if (!on) return image;
  image.setTo(cv::Scalar(60, 48, 40));
  write_lines(image, {20, 20, size.width / 2 - 30, size.height - 60}, 11, {210, 220, 200});
  const cv::Rect window(size.width / 2, size.height / 10, size.width * 4 / 10, size.height / 2);
  picture(image(window));
  cv::rectangle(image, cv::Rect(0, size.height - 24, size.width, 24), {140, 110, 90}, cv::FILLED);
  return image;
}

cv::Mat Painter::cardboard(cv::Size size) {
  if (album_) return album_->one(size, random_);
  cv::Mat image = tint(noise(size, {4, 32}, 5, 0.6), {105, 145, 180}, 0.1);
  const int band = size.height / 8;
  cv::rectangle(image, cv::Rect(0, size.height / 2 - band / 2, size.width, band), {130, 175, 205},
                cv::FILLED);
  write_lines(image, {size.width / 12, size.height / 10, size.width / 2, size.height / 4},
              size.height / 14.0, {40, 60, 80});
  picture(
      image(cv::Rect(size.width * 6 / 10, size.height * 6 / 10, size.width / 4, size.height / 4)));
  return image;
}

cv::Mat Painter::metal(cv::Size size, cv::Scalar base) {
  return tint(noise(size, {4, 4}, 6, 0.6), base, 0.06);
}

cv::Mat Painter::plaid(cv::Size size, cv::Scalar base) {
  cv::Mat image = fabric(size, base, 0.12);
  const int pitch = size.width / 8;
  const auto stripe = [&](cv::Rect rect, cv::Scalar tone) {
    cv::Mat part = image(rect & cv::Rect({0, 0}, size));
    cv::addWeighted(part, 0.5, cv::Mat(part.size(), CV_8UC3, tone), 0.5, 0, part);
  };
  const cv::Scalar dark = base * 0.25;
  for (int x = 0; x < size.width; x += pitch) {
    stripe({x, 0, pitch / 2, size.height}, dark);
    stripe({x + pitch * 3 / 4, 0, pitch / 12 + 1, size.height}, {230, 235, 235});
  }
  for (int y = 0; y < size.height; y += pitch) {
    stripe({0, y, size.width, pitch / 2}, dark);
    stripe({0, y + pitch * 3 / 4, size.width, pitch / 12 + 1}, {230, 235, 235});
  }
  return image;
}

cv::Mat Painter::stripes(cv::Size size, cv::Scalar base) {
  cv::Mat image = fabric(size, base, 0.12);
  const int pitch = size.height / 12;
  for (int y = 0; y < size.height; y += pitch)
    image.rowRange(y, std::min(y + pitch / 3, size.height)) *= 0.35;
  return image;
}

cv::Mat Painter::fabric(cv::Size size, cv::Scalar base, double contrast) {
  const cv::Mat folds = noise(size, {5, 3}, 4, 0.6);
  const cv::Mat threads = noise(size, {64, 64}, 3, 0.9);
  return tint(folds + 0.5 * threads, base, contrast);
}

cv::Mat Painter::face(cv::Size size) {
  // u runs around the head from its front, v from the chin (bottom rows) to the crown.
  cv::Mat image = tint(noise(size, {4, 4}, 5), {120, 150, 205}, 0.07);
  const cv::Scalar hair(28, 38, 52);
  const cv::Mat strands = tint(noise(size, {48, 6}, 4, 0.8), hair, 0.5);
  const int w = size.width;
  const int h = size.height;
  strands.rowRange(0, h * 30 / 100).copyTo(image.rowRange(0, h * 30 / 100));
  const cv::Rect back(w * 22 / 100, 0, w * 56 / 100, h * 70 / 100);
  strands(back).copyTo(image(back));
  for (const int side : {-1, 1}) {
    const auto at = [&](int percent_x, int percent_y) {
      return cv::Point((w + side * w * percent_x / 100) % w, h * percent_y / 100);
    };
    cv::ellipse(image, at(6, 45), {w / 40, h / 60}, 0, 0, 360, {235, 235, 235}, cv::FILLED);
    cv::circle(image, at(6, 45), h / 70, {40, 40, 40}, cv::FILLED, cv::LINE_AA);
    cv::ellipse(image, at(6, 40), {w / 30, h / 100}, 0, 0, 360, hair, cv::FILLED, cv::LINE_AA);
    cv::ellipse(image, at(2, 68), {w / 30, h / 90}, 0, 0, 360, {90, 90, 170}, cv::FILLED);
  }
  return image;
}

cv::Mat Painter::leaves(cv::Size size) {
  cv::Mat image(size, CV_8UC3, cv::Scalar(20, 45, 25));
  for (int i = 0; i < 500; ++i) {
    cv::ellipse(image, {uniform(0, size.width), uniform(0, size.height)},
                {uniform(10, 26), uniform(4, 9)}, uniform(0, 180), 0, 360,
                {double(uniform(20, 70)), double(uniform(70, 170)), double(uniform(30, 90))},
                cv::FILLED, cv::LINE_AA);
  }
  return image;
}

cv::Mat Painter::ball(cv::Size size) {
  cv::Mat image = fabric(size, {60, 110, 220}, 0.08);
  const int cell = size.width / 8;
  for (int y = 0; y < size.height; y += cell)
    for (int x = (y / cell % 2) * cell; x < size.width; x += 2 * cell)
      cv::circle(image, {x + cell / 2, y + cell / 2}, cell / 3, {230, 230, 230}, cv::FILLED);
  return image;
}

cv::Mat Painter::ceiling(cv::Size size) {
  cv::Mat image = tint(noise(size, {32, 32}, 4, 0.8), {214, 216, 216}, 0.06);
  for (int i = 0; i < 900; ++i) {
    const cv::Point hole(uniform(0, size.width), uniform(0, size.height));
    cv::circle(image, hole, 1, cv::Scalar::all(130), cv::FILLED, cv::LINE_AA);
  }
  cv::rectangle(image, cv::Rect({0, 0}, size), cv::Scalar::all(120), 3);
  return image;
}

}  // namespace stillpoint::simulation
