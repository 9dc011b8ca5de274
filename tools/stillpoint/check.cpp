// stillpoint check: finds every fault of a pipeline file without running anything.
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "stillpoint/engine/pipeline_warnings.hpp"

namespace stillpoint {

void add_check(CLI::App& app) {
  struct Arguments {
    PipelineRequest request;
    bool print = false;
  };
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = app.add_subcommand("check", "Validate a pipeline file without running it");
  add_pipeline_options(*command, arguments->request);
  command->add_flag("--print", arguments->print,
                    "Write the complete effective file: every option, explained");
  command->callback([arguments] {
    const LateCalls late = watch_loading();
    Registry registry;
    const PipelineConfig config = load_pipeline(arguments->request, registry);
    for (const std::string& warning : warnings_of(config))
      std::cerr << "warning: " << warning << '\n';
    if (arguments->print)
      std::cout << config.effective_yaml;
    else
      std::cout << config.file.string() << ": no faults\n";
  });
}

}  // namespace stillpoint
