#include "command/command_line.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/failure.h"
#include "command/terminal.h"
#include "scenes/suggestion.h"

namespace sheave::command {
namespace {

constexpr std::size_t first_column = 30;
constexpr std::size_t text_width = 100 - first_column;

/// `text` with line breaks so that no line is longer than `width`, except for a single longer word.
std::string wrapped(const std::string& text, std::size_t width) {
  std::string result;
  std::size_t column = 0;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::size_t length = end - begin;
    if (column > 0) {
      const bool fits = column + 1 + length <= width;
      result += fits ? ' ' : '\n';
      column = fits ? column + 1 : 0;
    }
    result.append(text, begin, length);
    column += length;
    begin = end + 1;
  }
  return result;
}

class WrappedFormatter final : public CLI::Formatter {
 public:
  [[nodiscard]] std::string make_option_desc(const CLI::Option* option) const override {
    return wrapped(option->get_description(), text_width);
  }
};

/// The command to which an error belongs: the innermost selected subcommand.
const CLI::App* innermost(const CLI::App& app, std::string& name) {
  const CLI::App* chosen = &app;
  name = app.get_name();
  while (!chosen->get_subcommands().empty()) {
    chosen = chosen->get_subcommands().front();
    name += " " + chosen->get_name();
  }
  return chosen;
}

/// The message about arguments that no option took.
std::string unexpected(const CLI::App& app, const CLI::App& chosen) {
  const std::vector<std::string> rest = app.remaining(true);
  if (rest.empty()) return "unexpected arguments";
  // CLI11 cannot tell which words were meant as values of an unknown option.
  const auto option = std::find_if(rest.begin(), rest.end(),
                                   [](const std::string& word) { return word.starts_with("-"); });
  const std::string word = option != rest.end() ? *option : rest.front();
  const std::string name = word.substr(0, word.find('='));
  std::vector<std::string> known;
  for (const CLI::Option* candidate : chosen.get_options()) {
    if (!candidate->get_lnames().empty()) known.push_back("--" + candidate->get_lnames().front());
  }
  Suggestion suggestion(name);
  for (const std::string& candidate : known) suggestion.consider(candidate);
  return "unexpected argument \"" + word + "\"" + suggestion.question();
}

}  // namespace

void use_wrapped_help(CLI::App& app) {
  auto formatter = std::make_shared<WrappedFormatter>();
  formatter->column_width(first_column);
  app.formatter(formatter);
}

void check_subcommands(const CLI::App& app, int argc, const char* const* words) {
  const CLI::App* level = &app;
  std::string path = app.get_name();
  for (int i = 0; i < argc; ++i) {
    const auto choices = level->get_subcommands([](const CLI::App*) { return true; });
    const std::string word = words[i];
    if (choices.empty() || word.starts_with("-")) return;
    Suggestion suggestion(word);
    std::vector<std::string> names;
    for (const CLI::App* choice : choices) names.push_back(choice->get_name());
    const auto found = std::find(names.begin(), names.end(), word);
    if (found == names.end()) {
      for (const std::string& name : names) suggestion.consider(name);
      throw Failure(ExitCode::usage, "there is no \"" + path + " " + word + "\"" +
                                         suggestion.question() + "\nSee " + path + " --help");
    }
    path += " " + word;
    level = choices[static_cast<std::size_t>(found - names.begin())];
  }
}

bool parse_command_line(CLI::App& app, int argc, const char* const* argv) {
  check_subcommands(app, argc - 1, argv + 1);
  std::string name;
  try {
    app.parse(argc, argv);
    return true;
  } catch (const CLI::CallForHelp&) {
    std::string help = app.help();
    if (!help.ends_with('\n')) help += '\n';
    print(help);
  } catch (const CLI::CallForVersion& version) {
    print(std::string(version.what()) + "\n");
  } catch (const CLI::ExtrasError&) {
    const CLI::App* chosen = innermost(app, name);
    throw Failure(ExitCode::usage, unexpected(app, *chosen) + "\nSee " + name + " --help");
  } catch (const CLI::ParseError& error) {
    innermost(app, name);
    throw Failure(ExitCode::usage, std::string(error.what()) + "\nSee " + name + " --help");
  }
  return false;
}

CLI::Validator number_between(double low, double high) {
  const std::string allowed = fmt::format("a number from {} to {}", low, high);
  return {[=](const std::string& text) {
            double value = 0.0;
            const bool number = CLI::detail::lexical_cast(text, value);
            // This form of the condition refuses NaN.
            if (number && value >= low && value <= high) return std::string();
            return fmt::format("{} is not {}", text, allowed);
          },
          "", "number_between"};
}

CLI::Validator finite_number() {
  return {[](const std::string& text) {
            double value = 0.0;
            if (CLI::detail::lexical_cast(text, value) && std::isfinite(value)) {
              return std::string();
            }
            return text + " is not a finite number";
          },
          "", "finite_number"};
}

}  // namespace sheave::command
