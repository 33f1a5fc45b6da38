// SPDX-License-Identifier: MIT
// Command-line options common to every program, and the type of a subcommand. Only sources that
// parse a command line include this header (CLI11 is slow to compile).
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "atmosphere/base/error.h"
#include "atmosphere/base/parsing.h"
#include "lut/cli/command_words.h"
#include "lut/cli/program.h"
#include "lut/cli/terminal.h"
#include "lut/layer.h"

namespace alpenglow::lut {

struct CommonOptions {
  int threads = 0;
  bool quiet = false;
  std::string progress = "auto";

  [[nodiscard]] ProgressStyle progress_style() const {
    return quiet ? ProgressStyle::kQuiet : ProgressStyleFromName(progress);
  }
};

/// The function of a subcommand, with its own parsed options bound to it. Each subcommand has a
/// pair of files NAME_command.h and .cpp with `Subcommand AddNameCommand(CLI::App&)`.
using Subcommand = std::function<void(const CommonOptions&)>;

/// Titles of the groups of options in --help. A program prints its groups in the order in which it
/// begins them; all use the order of this list.
inline constexpr char kPlaceGroup[] = "Place and camera";
inline constexpr char kTimeGroup[] = "Time";
inline constexpr char kAirGroup[] = "Air";
inline constexpr char kPictureGroup[] = "Light and picture";
inline constexpr char kOutputGroup[] = "Output";
inline constexpr char kDiagnosticsGroup[] = "Diagnostics";

/// Begins a group: --help lists the options that are added after this call under `title`.
inline void BeginGroup(CLI::App& app, const char* title) { app.option_defaults()->group(title); }

/// Begins the last group and moves --help to it. CLI11 adds --help before all other options.
inline void BeginDiagnostics(CLI::App& app) {
  BeginGroup(app, kDiagnosticsGroup);
  app.set_help_flag("-h,--help", "Print this help and exit");
}

/// Returns a validator that accepts the numbers in [low, high]. CLI::Range accepts NaN, too.
template <typename Number>
[[nodiscard]] CLI::Validator InRange(Number low, Number high) {
  const CLI::Range range(low, high);
  const auto fault = [=](std::string& text) -> std::string {
    const std::optional<double> number = ParseNumber(text);
    if (number && std::isnan(*number))
      return fmt::format("Value {} not in range {} to {}", text, low, high);
    return range(text);
  };
  return CLI::Validator(fault, range.get_description());
}

/// Adds --atmosphere. `atmosphere` must outlive the parsing.
inline void AddAtmosphereOption(CLI::App& command, std::optional<std::string>& atmosphere) {
  command.add_option("--atmosphere", atmosphere,
                     "Atmosphere file (TOML) or preset: earth, hazy, clear-mountain, mars, "
                     "bruneton2017 (default: the preset earth)");
}

/// Help texts of options that several programs have.
inline constexpr char kToneMapHelp[] =
    "Tone curve of the PNG. \"local\" applies local exposure, then agx";
inline constexpr char kNightVisionHelp[] =
    "Show in the PNG what an eye sees that is adapted to the dark: below 5 cd/m^2 colour fades and "
    "fine detail is lost";

/// Adds --threads, --quiet, --progress, --version and --help. `options` must outlive the parsing.
inline void AddCommonOptions(CLI::App& app, const std::string& program, CommonOptions& options) {
  BeginDiagnostics(app);
  app.add_option("--threads", options.threads, "Number of threads; 0 uses all")
      ->check(InRange(0, 4096))
      ->capture_default_str();
  app.add_flag("--quiet", options.quiet,
               "Suppress progress and the summary, but not warnings, on standard error");
  app.add_option("--progress", options.progress,
                 "Form of progress on standard error: auto, plain, json or quiet")
      ->check(CLI::IsMember(ProgressStyleNames()))
      ->capture_default_str();
  app.set_version_flag(
      "--version", [program] { return VersionText(program); }, "Print the version and exit");
}

/// Returns a validator that rejects a text on the command line if `read` throws for it.
[[nodiscard]] inline CLI::Validator ReadableBy(
    const std::function<void(const std::string&)>& read) {
  const auto fault = [read](const std::string& text) -> std::string {
    try {
      read(text);
      return "";
    } catch (const InputError& error) {
      return error.what();
    }
  };
  return CLI::Validator(fault, "");
}

/// Returns the long names of the options that a command line may have: those of the subcommand that
/// was named, and those of the program if the subcommand passes them on to it (fallthrough).
[[nodiscard]] inline std::vector<std::string> OptionNamesOf(const CLI::App& app) {
  std::vector<std::string> names;
  const std::vector<CLI::App*> named = app.get_subcommands();
  for (const CLI::App* command : named) {
    const std::vector<std::string> more = OptionNamesOf(*command);
    names.insert(names.end(), more.begin(), more.end());
  }
  if (!named.empty() && !named.back()->get_fallthrough()) return names;
  for (const CLI::Option* option : app.get_options())
    names.insert(names.end(), option->get_lnames().begin(), option->get_lnames().end());
  return names;
}

/// Returns the commands (the program without its subcommands, or a subcommand) that have an option
/// of exactly this name, except the one that was named.
[[nodiscard]] inline std::vector<std::string> CommandsWith(const CLI::App& app,
                                                           const std::string& name) {
  const auto has = [&](const CLI::App& command) {
    const std::vector<const CLI::Option*> options = command.get_options();
    return std::any_of(options.begin(), options.end(),
                       [&](const CLI::Option* option) { return option->check_lname(name); });
  };
  std::vector<std::string> commands;
  if (has(app)) commands.push_back(app.get_name());
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (has(*command)) commands.push_back(app.get_name() + " " + command->get_name());
  }
  return commands;
}

/// Describes a value that is no number, with the option's help, which has its range; empty for
/// another error.
[[nodiscard]] inline std::string FaultOfNumber(const CLI::App& app, std::string_view message) {
  for (const CLI::Option* option : app.get_options()) {
    const std::string begin = fmt::format("Could not convert: {} = ", option->get_name());
    if (!message.starts_with(begin)) continue;
    const std::string_view value = message.substr(begin.size());
    const bool is_whole = option->get_type_name().find("INT") != std::string::npos;
    const bool has_comma = value.find(',') != std::string_view::npos;
    return fmt::format("{} is \"{}\"; it must be a {}number{}: {}", option->get_name(), value,
                       is_whole ? "whole " : "", has_comma ? " with a decimal point" : "",
                       option->get_description());
  }
  for (const CLI::App* command : app.get_subcommands()) {
    if (std::string fault = FaultOfNumber(*command, message); !fault.empty()) return fault;
  }
  return "";
}

/// Describes the fault of the first word, or of the first unknown option; empty if there is none.
/// It must be called before other parser errors are reported, because they are consequences of this
/// fault.
[[nodiscard]] inline std::string FaultOfWords(const CLI::App& app, int argc, char** argv) {
  std::vector<std::string> commands;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    commands.push_back(command->get_name());
  if (argc > 1) {
    if (std::string fault = FaultOfCommand(argv[1], commands); !fault.empty()) return fault;
  }
  for (const std::string& word : app.remaining(true)) {
    if (word.size() <= 1 || !word.starts_with('-')) continue;
    const std::vector<std::string> others = CommandsWith(app, LongNameOf(word));
    return others.empty() ? FaultOfUnknownOption(word, OptionNamesOf(app))
                          : FaultOfOptionOfOthers(word, others);
  }
  return "";
}

/// Prints the help in lines that the terminal holds.
inline void PrintHelp(const CLI::App& app) {
  constexpr int kUsualColumns = 100, kLeastColumns = 20;
  const int columns = std::max(ColumnsOf(STDOUT_FILENO, kUsualColumns), kLeastColumns);
  const CLI::App* root = &app;
  while (root->get_parent() != nullptr) root = root->get_parent();
  Print(Wrapped(app.help(), static_cast<std::size_t>(columns), root->get_name() + " "));
}

/// Returns the subcommand that was named, or the program.
[[nodiscard]] inline const CLI::App& NamedCommandOf(const CLI::App& app) {
  const std::vector<CLI::App*> named = app.get_subcommands();
  return named.empty() ? app : NamedCommandOf(*named.back());
}

/// Parses the command line. Returns an exit status if the program has nothing left to do: 0 after
/// --help and --version, 2 if the command line is wrong.
inline std::optional<int> ParseCommandLine(CLI::App& app, int argc, char** argv) {
  std::string fault;
  try {
    app.parse(argc, argv);
    fault = FaultOfWords(app, argc, argv);
    if (fault.empty()) return std::nullopt;
  } catch (const CLI::CallForHelp&) {
    PrintHelp(NamedCommandOf(app));
    return 0;
  } catch (const CLI::ParseError& error) {
    const bool is_fault = error.get_exit_code() != 0;
    if (is_fault) fault = FaultOfWords(app, argc, argv);
    if (is_fault && fault.empty()) fault = FaultOfNumber(app, error.what());
    if (!is_fault) return app.exit(error);
    if (fault.empty()) fault = error.what();
  }
  Log(fmt::format("{}: {}\nRun with --help for more information.\n", app.get_name(), fault));
  return 2;
}

}  // namespace alpenglow::lut
