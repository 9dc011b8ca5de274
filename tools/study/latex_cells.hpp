// Cells of tables in LaTeX, and what captions say of the marks in them.
#pragma once

#include <optional>
#include <string>

#include "study/latex_table.hpp"
#include "study/study_results.hpp"

namespace stillpoint::study {

/// What stands where there is no figure.
inline constexpr const char* kNoFigure = "--";

std::string latex_bold(const std::string& text);
std::string latex_italic(const std::string& text);

/// Median (smallest–largest), bold where it is the best.
std::string latex_spread(const std::optional<Spread>& spread, int digits, bool best = false);
/// Median (quartiles).
std::string latex_ratio(const std::optional<Spread>& spread);
/// A published figure, in italics.
std::string latex_published(const Published& system, const std::string& recording, MetricId metric);
/// Behind a figure, in square brackets: what limits it. Nothing without a note.
std::string latex_limit(const std::string& note);

/// What stands in square brackets in the table; nothing of what does not.
std::string brackets_note(const LatexTable& table);
/// `note`, where something is bold.
std::string bold_note(const LatexTable& table, const std::string& note);
bool has_italics(const LatexTable& table);

}  // namespace stillpoint::study
