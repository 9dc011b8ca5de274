// stillpoint run-cell: one run of a study, as a job of a cluster makes it.
#include <csignal>
#include <filesystem>
#include <memory>

#include "commands.hpp"
#include "commit.hpp"
#include "interrupt.hpp"
#include "study/cell_list.hpp"

namespace stillpoint {
namespace {

struct RunCellArguments {
  std::filesystem::path cells;
  std::size_t number = 0;
};

/// Leaves no result when a signal ends it: the job then says why it was cancelled.
void run_listed_cell(const RunCellArguments& arguments) {
  const study::ListedCell listed = study::read_cell(arguments.cells, arguments.number);
  if (study::valid_result(listed.cell)) return;  // Slurm has queued it again
  int signal = 0;
  {
    const Interrupt interrupt([](const std::string&) {});
    study::run_cell(listed.cell,
                    {.fingerprint = listed.program,
                     .version = STILLPOINT_VERSION,
                     .commit = built_from_commit()},
                    interrupt.token());
    signal = Interrupt::signal();
  }
  if (signal != 0) std::raise(signal);
}

}  // namespace

void add_run_cell(CLI::App& app) {
  auto arguments = std::make_shared<RunCellArguments>();
  CLI::App* command = app.add_subcommand("run-cell", "Make one run of a study")->group("");
  command->add_option("cells", arguments->cells, "List of cells, written by ablate")->required();
  command->add_option("number", arguments->number, "Line of the list, counted from 0")->required();
  command->callback([arguments] { run_listed_cell(*arguments); });
}

}  // namespace stillpoint
