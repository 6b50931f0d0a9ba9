#pragma once
// How the command line is read: help that fits a terminal, and answers to words nobody knows.

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

/// Reads the command line. Prints help or the version and returns false if that was asked for;
/// throws a Failure (2) if something is wrong.
[[nodiscard]] bool parse_command_line(CLI::App& app, int argc, const char* const* argv);

/// A number from `low` to `high`. CLI11's own checks let "nan" pass, which is in no range and out
/// of none.
[[nodiscard]] CLI::Validator number_between(double low, double high);
/// A number that is neither infinite nor "nan".
[[nodiscard]] CLI::Validator finite_number();

}  // namespace sheave::command
