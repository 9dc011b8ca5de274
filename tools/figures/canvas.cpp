#include "figures/canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <cmath>
#include <numbers>

#include "figures/text.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::figures {
namespace {

constexpr const char* kFont = "DejaVu Sans";  // comes with Cairo's font configuration
constexpr double kPixelsPerPt = 3;            // of PNG: 216 per inch

cairo_status_t append(void* bytes, const unsigned char* data, unsigned length) {
  static_cast<std::string*>(bytes)->append(reinterpret_cast<const char*>(data), length);
  return CAIRO_STATUS_SUCCESS;
}

cairo_surface_t* new_surface(Format format, double width, double height, std::string& bytes) {
  switch (format) {
    case Format::kSvg:
      return cairo_svg_surface_create_for_stream(append, &bytes, width, height);
    case Format::kPdf:
      return cairo_pdf_surface_create_for_stream(append, &bytes, width, height);
    case Format::kPng:
      break;
  }
  const auto pixels = [](double pt) { return static_cast<int>(std::ceil(pt * kPixelsPerPt)); };
  cairo_surface_t* image =
      cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(width), pixels(height));
  cairo_surface_set_device_scale(image, kPixelsPerPt, kPixelsPerPt);
  return image;
}

// Without hinting, letters are as wide at every size and in every format.
void set_font(cairo_t* context, double size_pt) {
  cairo_font_options_t* options = cairo_font_options_create();
  cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_antialias(options, CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context, options);
  cairo_font_options_destroy(options);
  cairo_select_font_face(context, kFont, CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size_pt);
}

double advance(cairo_t* context, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(context, text.c_str(), &extents);
  return extents.x_advance;
}

void set_colour(cairo_t* context, const Colour& colour, double opacity) {
  cairo_set_source_rgba(context, colour.red, colour.green, colour.blue, opacity);
}

void add_path(cairo_t* context, std::span<const Eigen::Vector2d> points) {
  cairo_new_path(context);
  for (const Eigen::Vector2d& point : points) cairo_line_to(context, point.x(), point.y());
}

}  // namespace

struct Canvas::Cairo {
  Format format;
  std::string title, bytes;
  cairo_surface_t* surface;
  cairo_t* context;
};

double text_width_pt(const std::string& text, double size_pt) {
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
  cairo_t* context = cairo_create(surface);
  set_font(context, size_pt);
  const double width = advance(context, valid_text(text));
  cairo_destroy(context);
  cairo_surface_destroy(surface);
  return width;
}

std::string shortened(const std::string& text, double size_pt, double width_pt) {
  if (text_width_pt(text, size_pt) <= width_pt) return text;
  std::string beginning = valid_text(text);
  while (!beginning.empty() && text_width_pt(beginning + "…", size_pt) > width_pt)
    remove_last_letter(beginning);
  return beginning + "…";
}

Canvas::Canvas(Format format, double width_pt, double height_pt, const std::string& title)
    : cairo_(std::make_unique<Cairo>()) {
  cairo_->format = format;
  cairo_->title = valid_text(title);
  cairo_->surface = new_surface(format, width_pt, height_pt, cairo_->bytes);
  if (format == Format::kPdf) {
    cairo_pdf_surface_set_metadata(cairo_->surface, CAIRO_PDF_METADATA_TITLE,
                                   cairo_->title.c_str());
    // The same figure is the same file: no date.
    cairo_pdf_surface_set_metadata(cairo_->surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
  }
  cairo_->context = cairo_create(cairo_->surface);
  cairo_set_line_join(cairo_->context, CAIRO_LINE_JOIN_ROUND);
  set_colour(cairo_->context, kPaper, 1.0);
  cairo_paint(cairo_->context);
}

Canvas::~Canvas() {
  cairo_destroy(cairo_->context);
  cairo_surface_destroy(cairo_->surface);
}

void Canvas::line(std::span<const Eigen::Vector2d> points, const Pen& pen) {
  cairo_t* context = cairo_->context;
  add_path(context, points);
  set_colour(context, pen.colour, 1.0);
  cairo_set_line_width(context, pen.width_pt);
  constexpr double kDashes[] = {3.5, 2.0};
  cairo_set_dash(context, kDashes, pen.dashed ? 2 : 0, 0);
  cairo_set_line_cap(context, pen.dashed ? CAIRO_LINE_CAP_BUTT : CAIRO_LINE_CAP_ROUND);
  cairo_stroke(context);
}

void Canvas::fill(std::span<const Eigen::Vector2d> outline, const Colour& colour, double opacity) {
  add_path(cairo_->context, outline);
  set_colour(cairo_->context, colour, opacity);
  cairo_fill(cairo_->context);
}

void Canvas::fill(const Box& box, const Colour& colour, double opacity) {
  cairo_new_path(cairo_->context);
  cairo_rectangle(cairo_->context, box.x, box.y, box.width, box.height);
  set_colour(cairo_->context, colour, opacity);
  cairo_fill(cairo_->context);
}

void Canvas::dot(const Eigen::Vector2d& at, double radius_pt, const Colour& colour) {
  cairo_new_path(cairo_->context);
  cairo_arc(cairo_->context, at.x(), at.y(), radius_pt, 0, 2 * std::numbers::pi);
  set_colour(cairo_->context, colour, 1.0);
  cairo_fill(cairo_->context);
}

void Canvas::text(const std::string& text, const Eigen::Vector2d& at, double size_pt, Anchor anchor,
                  bool upright) {
  constexpr double kCapitals = 0.73;  // height of capital letters, of the size of the font
  cairo_t* context = cairo_->context;
  const std::string valid = valid_text(text);
  cairo_save(context);
  set_font(context, size_pt);
  set_colour(context, kInk, 1.0);
  cairo_translate(context, at.x(), at.y());
  if (upright) cairo_rotate(context, -std::numbers::pi / 2);
  cairo_move_to(context, -anchor.x * advance(context, valid), (1 - anchor.y) * kCapitals * size_pt);
  cairo_show_text(context, valid.c_str());
  cairo_restore(context);
}

void Canvas::clip(const Box& box) {
  cairo_save(cairo_->context);
  cairo_new_path(cairo_->context);
  cairo_rectangle(cairo_->context, box.x, box.y, box.width, box.height);
  cairo_clip(cairo_->context);
}

void Canvas::unclip() { cairo_restore(cairo_->context); }

std::string Canvas::finish() {
  cairo_status_t status = cairo_status(cairo_->context);
  if (status == CAIRO_STATUS_SUCCESS && cairo_->format == Format::kPng)
    status = cairo_surface_write_to_png_stream(cairo_->surface, append, &cairo_->bytes);
  cairo_surface_finish(cairo_->surface);
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(cairo_->surface);
  if (status != CAIRO_STATUS_SUCCESS)
    throw Error(Fault::kStage,
                std::string("the figure cannot be drawn: ") + cairo_status_to_string(status),
                cairo_->title);
  return cairo_->format == Format::kSvg ? with_title(cairo_->bytes, cairo_->title) : cairo_->bytes;
}

}  // namespace stillpoint::figures
