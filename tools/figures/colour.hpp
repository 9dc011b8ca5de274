// Colours that people with any kind of colour vision tell apart.
#pragma once

#include <cstddef>

namespace stillpoint::figures {

/// sRGB, each 0 … 1.
struct Colour {
  double red, green, blue;
  bool operator==(const Colour&) const = default;
};

inline constexpr Colour kInk{0.15, 0.16, 0.18}, kReferenceGrey{0.62, 0.63, 0.65},
    kOtherPartsGrey{0.75, 0.75, 0.76}, kGridGrey{0.90, 0.90, 0.91}, kPaper{1, 1, 1};

/// Of the i-th run (Okabe & Ito, Color Universal Design, 2008); again from the first after the
/// last.
Colour run_colour(std::size_t index);
inline constexpr std::size_t kRunColours = 6;

/// Of the i-th part of a whole, for areas (P. Tol, Colour Schemes, 2021: "muted");
/// again from the first after the last.
Colour part_colour(std::size_t index);
inline constexpr std::size_t kPartColours = 9;

/// Of a value between the least (0) and the greatest (1): the darker, the smaller (the colour map
/// "plasma" without its light end).
Colour value_colour(double share);

}  // namespace stillpoint::figures
