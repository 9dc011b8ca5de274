#include "figures/figure_file.hpp"

#include "figures/axes.hpp"
#include "figures/layout.hpp"
#include "figures/marks.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint::figures {

Format format_of(const std::filesystem::path& file) {
  const std::string ending = file.extension().string();
  if (ending == ".png") return Format::kPng;
  if (ending == ".svg") return Format::kSvg;
  if (ending == ".pdf") return Format::kPdf;
  throw Error(Fault::kUsage, "a figure is a .png, .svg or .pdf file", file.string(),
              "end the name with one of these");
}

std::string draw(const Figure& figure, Format format) {
  const Layout layout = lay_out(figure);
  Canvas canvas(format, layout.width_pt, layout.height_pt, figure.title);
  for (const LegendPlace& entry : layout.legend) {
    draw_sample(canvas, entry.at, *entry.mark);
    canvas.text(entry.text, entry.at + Eigen::Vector2d(kSamplePt + kTextGapPt, 0), kTextPt,
                {0, 0.5});
  }
  for (const PanelPlace& place : layout.panels) {
    draw_grid(canvas, place);
    canvas.clip(place.axes);
    for (const Mark& mark : place.panel->marks) draw_mark(canvas, place, figure.colour_scale, mark);
    canvas.unclip();
    draw_axes(canvas, place, layout.numbers_pt);
  }
  if (layout.colour_bar) draw_colour_bar(canvas, *layout.colour_bar, *figure.colour_scale);
  return canvas.finish();
}

void write_figure(const Figure& figure, const std::filesystem::path& file) {
  const std::string bytes = draw(figure, format_of(file));
  AtomicFile output(file);
  output.stream() << bytes;
  output.commit();
}

}  // namespace stillpoint::figures
