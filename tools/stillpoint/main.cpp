// The command line.
#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <exception>
#include <iostream>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "commit.hpp"
#include "stillpoint/engine/freed_memory.hpp"
#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/engine/thread_watch.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace {

using stillpoint::Error;
using stillpoint::Fault;

constexpr void (*kCommands[])(CLI::App&) = {
#include "command_list.inc"
};

constexpr const char* kExitCodes =
    "Exit codes: 0 done, 1 a stage failed, 2 wrong usage or configuration, 3 unusable data, "
    "130 stopped by Ctrl-C (128 + the number of the signal)";

/// CLI11 would only say that a subcommand is required. `words` begins with what should be one.
void check_command(const CLI::App& app, std::span<char*> words, const std::string& where) {
  const std::vector<const CLI::App*> commands = app.get_subcommands({});
  if (commands.empty() || words.empty() || words[0][0] == '-') return;
  const std::string word = words[0];
  std::vector<std::string> names;
  for (const CLI::App* command : commands) {
    if (command->get_name() == word)
      return check_command(*command, words.subspan(1), where + ' ' + word);
    if (!command->get_group().empty()) names.push_back(command->get_name());
  }
  const std::string suggestion = stillpoint::did_you_mean(word, names);
  throw Error(Fault::kUsage, "no command '" + word + "'" + suggestion, where,
              suggestion.empty() ? "there are: " + stillpoint::join(names) : "");
}

/// The command that the words chose, and its name as it was typed.
std::pair<const CLI::App*, std::string> chosen_command(const CLI::App& app) {
  const CLI::App* command = &app;
  std::string name = app.get_name();
  while (!command->get_subcommands().empty()) {
    command = command->get_subcommands().front();
    name += ' ' + command->get_name();
  }
  return {command, name};
}

std::vector<std::string> option_names(const CLI::App& command) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  return names;
}

/// What a word without an option was meant as; empty: not known.
std::string remedy_for(const std::string& word, const std::vector<std::string>& known) {
  const auto has = [&](const char* option) {
    return std::ranges::find(known, option) != known.end();
  };
  const bool is_number = word.find_first_not_of("0123456789") == std::string::npos;
  if (is_number && has("--view")) return "a port is given as '--view=" + word + "'";
  if (has("--dataset")) return "a recording is given as '--dataset " + word + "'";
  return "";
}

/// CLI11 would only say which words were not expected.
void check_options(const CLI::App& app) {
  const auto [command, name] = chosen_command(app);
  const std::vector<std::string> known = option_names(*command);
  for (const std::string& word : app.remaining(true)) {
    if (word.empty()) continue;
    if (word[0] != '-') {
      const std::string remedy = remedy_for(word, known);
      if (remedy.empty()) continue;
      throw Error(Fault::kUsage, "'" + word + "' was not expected", name, remedy);
    }
    const std::string option = word.substr(0, word.find('='));
    if (std::ranges::find(known, option) != known.end())
      throw Error(Fault::kUsage, "option '" + option + "' stands before the command", name,
                  "write '" + name + ' ' + option + "'");
    const std::string suggestion = stillpoint::did_you_mean(option, known);
    throw Error(Fault::kUsage, "no option '" + option + "'" + suggestion, name,
                suggestion.empty() ? "'" + name + " --help' lists them" : "");
  }
}

std::string version_text() {
  const std::string commit = stillpoint::built_from_commit();
  return "stillpoint " STILLPOINT_VERSION + (commit.empty() ? "" : " (commit " + commit + ")");
}

int run(int argc, char** argv) {
  CLI::App app{"RGB-D SLAM for scenes in which people and things move", "stillpoint"};
  app.set_version_flag("-V,--version", version_text());
  app.set_help_all_flag("--help-all", "Help of every subcommand");
  app.require_subcommand(1);
  app.fallthrough(false);
  app.footer(kExitCodes);
  app.failure_message([](const CLI::App* command, const CLI::Error& error) {
    return std::string("error: ") + error.what() + "\nRun '" + chosen_command(*command).second +
           " --help' for help.\n";
  });
  for (const auto add : kCommands) add(app);
  if (argc > 1 && argv[1] == std::string("--complete")) {
    stillpoint::print_completions(app, {argv + 2, argv + argc});
    return 0;
  }
  check_command(app, std::span(argv, static_cast<std::size_t>(argc)).subspan(1), "stillpoint");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0) check_options(app);
    return app.exit(error) == 0 ? 0 : static_cast<int>(Fault::kUsage);
  }
  return 0;
}

int run_and_say_why_not(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const stillpoint::ConfigError& error) {  // each of its lines says "error:" already
    std::cerr << error.what() << '\n';
    return error.exit_code();
  } catch (const Error& error) {
    std::cerr << "error: " << error.what() << '\n';
    return error.exit_code();
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return static_cast<int>(Fault::kStage);
  }
}

// A daemon may start the program without standard streams. The first file that it opens would take
// their place, and get what is meant for them.
void open_closed_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
      if (::open("/dev/null", O_RDWR) < 0) std::_Exit(static_cast<int>(Fault::kStage));
}

}  // namespace

int main(int argc, char** argv) {
  open_closed_streams();
  stillpoint::keep_freed_memory();
  std::signal(SIGPIPE, SIG_IGN);  // a reader such as `head` that goes early must cost no results
  const stillpoint::StageGuard guard;
  const int exit_code = run_and_say_why_not(argc, argv);
  if (!stillpoint::StageGuard::has_ended_a_call()) return exit_code;
  const std::string end = stillpoint::ThreadWatch::failure_text();
  if (exit_code == 0 && !end.empty()) std::cerr << "error: " << end << '\n';
  std::cout << std::flush;
  // Nothing more of that plugin is to be run. Where it crashed in a destructor, all is saved.
  std::_Exit(exit_code != 0 ? exit_code : static_cast<int>(Fault::kStage));
}
