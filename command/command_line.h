#pragma once
// Reading the command line: help that fits a terminal, and suggestions for unknown words.

#include <string>

namespace CLI {
class App;
class Validator;
}  // namespace CLI

namespace sheave::command {

/// Makes the help of `app` fit into 100 columns; subcommands added later inherit it.
void use_wrapped_help(CLI::App& app);

/// Throws a Failure (2), with a suggestion, if `words` name a subcommand that does not exist.
void check_subcommands(const CLI::App& app, int argc, const char* const* words);

/// Reads the command line. Prints help or the version and returns false if one of them was
/// requested; throws a Failure (2) if an argument is wrong.
[[nodiscard]] bool parse_command_line(CLI::App& app, int argc, const char* const* argv);

/// A number from `low` to `high`. CLI11's own range check accepts "nan", because every comparison
/// with NaN is false.
[[nodiscard]] CLI::Validator number_between(double low, double high);
/// A number that is neither infinite nor "nan".
[[nodiscard]] CLI::Validator finite_number();

}  // namespace sheave::command
