// Whether LaTeX takes what we write for it.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <string>

#include "support/program.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::testing {

inline bool has_latex() { return std::system("pdflatex -version >/dev/null 2>&1") == 0; }

/// Empty when a document with these tables becomes a PDF; what pdflatex prints otherwise.
inline std::string latex_complaints(const std::string& tables) {
  const TemporaryFolder folder;
  folder.write("tables.tex", tables);
  folder.write("paper.tex",
               "\\documentclass{article}\n\\usepackage{booktabs}\n\\begin{document}\n"
               "\\input{tables}\n\\end{document}\n");
  const std::string command = "cd '" + folder.path().string() +
                              "' && timeout 60 pdflatex -halt-on-error -interaction=nonstopmode "
                              "paper >printed 2>&1";
  if (std::system(command.c_str()) == 0 && std::filesystem::exists(folder.path() / "paper.pdf"))
    return "";
  return text_of(folder.path() / "printed");
}

#define SKIP_WITHOUT_LATEX()               \
  if (!::stillpoint::testing::has_latex()) \
  GTEST_SKIP() << "pdflatex is missing: texlive-latex-recommended"

}  // namespace stillpoint::testing
