// sheave completion: scripts with which a shell completes subcommands, options and files. The
// scripts are made from the tree of options that also parses the command line.

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include "command/registry.h"
#include "command/terminal.h"

namespace sheave::command {
namespace {

/// A sequence of words after `sheave` and the words that may follow it.
struct Level {
  std::vector<std::string> path;  ///< names of subcommands; empty: `sheave` itself
  const CLI::App* app = nullptr;
};

std::vector<const CLI::App*> subcommands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* sub) { return !sub->get_name().empty(); });
}

std::vector<const CLI::Option*> named_options(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return option->nonpositional(); });
}

void collect(const CLI::App& app, const std::vector<std::string>& path,
             std::vector<Level>& levels) {
  levels.push_back({path, &app});
  for (const CLI::App* sub : subcommands(app)) {
    std::vector<std::string> longer = path;
    longer.push_back(sub->get_name());
    collect(*sub, longer, levels);
  }
}

/// The levels below `sheave`, in the order of the help.
std::vector<Level> levels_of(const CLI::App& app) {
  std::vector<Level> levels;
  collect(app, {}, levels);
  return levels;
}

/// As a shell's word in single quotes, on one line.
std::string shell_word(const std::string& text) {
  std::string result = "'";
  for (const char c : text) {
    if (c == '\'') {
      result += "'\\''";
    } else {
      result += c == '\n' ? ' ' : c;
    }
  }
  return result + "'";
}

/// Every spelling of an option, with its dashes.
std::vector<std::string> spellings(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

std::string words_of(const Level& level) {
  std::vector<std::string> words;
  for (const CLI::App* sub : subcommands(*level.app)) words.push_back(sub->get_name());
  for (const CLI::Option* option : named_options(*level.app)) {
    for (std::string& name : spellings(*option)) words.push_back(std::move(name));
  }
  return fmt::format("{}", fmt::join(words, " "));
}

std::string bash_script(const CLI::App& app) {
  std::string cases;
  for (const Level& level : levels_of(app)) {
    cases += fmt::format("    {}) words={} ;;\n",
                         shell_word(fmt::format("{}", fmt::join(level.path, " "))),
                         shell_word(words_of(level)));
  }
  return fmt::format(R"(# bash completion for sheave, made by `sheave completion bash`.
_sheave() {{
  local current=${{COMP_WORDS[COMP_CWORD]}} path='' word words=''
  for word in "${{COMP_WORDS[@]:1:COMP_CWORD-1}}"; do
    [[ $word == -* ]] && break
    case "$path${{path:+ }}$word" in
      {}) path+="${{path:+ }}$word" ;;
      *) break ;;
    esac
  done
  case $path in
{}  esac
  COMPREPLY=()
  local reply
  while IFS= read -r reply; do COMPREPLY+=("$reply"); done < <(compgen -W "$words" -- "$current")
  [[ $current == -* ]] && return
  while IFS= read -r reply; do COMPREPLY+=("$reply"); done < <(compgen -f -- "$current")
}}
complete -o filenames -F _sheave sheave
)",
                     [&] {
                       std::vector<std::string> paths;
                       for (const Level& level : levels_of(app)) {
                         if (level.path.empty()) continue;
                         paths.push_back(shell_word(fmt::format("{}", fmt::join(level.path, " "))));
                       }
                       return fmt::format("{}", fmt::join(paths, " | "));
                     }(),
                     cases);
}

/// A description for zsh's _describe, in which an unescaped colon would end the name.
std::string zsh_item(const std::string& name, const std::string& meaning) {
  std::string escaped;
  for (const char c : name) {
    if (c == ':') escaped += '\\';
    escaped += c;
  }
  return shell_word(escaped + ":" + meaning);
}

std::string zsh_script(const CLI::App& app) {
  std::string cases;
  for (const Level& level : levels_of(app)) {
    std::string items;
    for (const CLI::App* sub : subcommands(*level.app)) {
      items += "      " + zsh_item(sub->get_name(), sub->get_description()) + "\n";
    }
    for (const CLI::Option* option : named_options(*level.app)) {
      for (const std::string& name : spellings(*option)) {
        items += "      " + zsh_item(name, option->get_description()) + "\n";
      }
    }
    cases += fmt::format("    {})\n      items=(\n{}      ) ;;\n",
                         shell_word(fmt::format("{}", fmt::join(level.path, " "))), items);
  }
  std::vector<std::string> paths;
  for (const Level& level : levels_of(app)) {
    if (!level.path.empty())
      paths.push_back(shell_word(fmt::format("{}", fmt::join(level.path, " "))));
  }
  return fmt::format(R"(#compdef sheave
# zsh completion for sheave, made by `sheave completion zsh`.
_sheave() {{
  local name='' word
  local -a items
  for word in "${{(@)words[2,CURRENT-1]}}"; do
    [[ $word == -* ]] && break
    case "$name${{name:+ }}$word" in
      {}) name+="${{name:+ }}$word" ;;
      *) break ;;
    esac
  done
  case $name in
{}  esac
  _describe -o 'sheave' items
  [[ $PREFIX == -* ]] || _files
}}
if [[ $funcstack[1] == _sheave ]]; then
  _sheave "$@"
else
  compdef _sheave sheave
fi
)",
                     fmt::join(paths, " | "), cases);
}

/// fish's condition that the cursor is directly after the subcommands of `path`.
std::string fish_condition(const Level& level) {
  if (level.path.empty()) return "__fish_use_subcommand";
  std::vector<std::string> seen;
  for (const std::string& name : level.path) {
    seen.push_back("__fish_seen_subcommand_from " + name);
  }
  return fmt::format("{}", fmt::join(seen, "; and "));
}

std::string fish_script(const CLI::App& app) {
  std::string text = "# fish completion for sheave, made by `sheave completion fish`.\n";
  for (const Level& level : levels_of(app)) {
    const std::string condition = shell_word(fish_condition(level));
    for (const CLI::App* sub : subcommands(*level.app)) {
      std::string only_here = fish_condition(level);
      if (!level.path.empty()) {
        std::vector<std::string> names;
        for (const CLI::App* other : subcommands(*level.app)) names.push_back(other->get_name());
        only_here += fmt::format("; and not __fish_seen_subcommand_from {}", fmt::join(names, " "));
      }
      text += fmt::format("complete -c sheave -f -n {} -a {} -d {}\n", shell_word(only_here),
                          sub->get_name(), shell_word(sub->get_description()));
    }
    for (const CLI::Option* option : named_options(*level.app)) {
      std::string names;
      for (const std::string& name : option->get_snames()) names += " -s " + name;
      for (const std::string& name : option->get_lnames()) names += " -l " + name;
      text += fmt::format("complete -c sheave -n {}{}{} -d {}\n", condition, names,
                          option->get_items_expected_max() > 0 ? " -r" : "",
                          shell_word(option->get_description()));
    }
  }
  return text;
}

/// A shell and the function that makes its script.
struct Shell {
  const char* name;
  std::string (*script)(const CLI::App& app);
};

constexpr Shell shells[] = {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}};

}  // namespace

Action declare_completion(CLI::App& app) {
  auto chosen = std::make_shared<std::string>();
  std::vector<std::string> names;
  for (const Shell& shell : shells) names.emplace_back(shell.name);
  app.add_option("shell", *chosen, fmt::format("{}", fmt::join(names, ", ")))
      ->option_text("SHELL")
      ->required()
      ->check(CLI::IsMember(names));
  app.footer(R"(Examples:
  sheave completion bash > ~/.local/share/bash-completion/completions/sheave
  sheave completion fish > ~/.config/fish/completions/sheave.fish
  source <(sheave completion zsh)

Debian's package has all three installed already.)");
  const CLI::App* sheave = app.get_parent();
  return [chosen, sheave] {
    for (const Shell& shell : shells) {
      if (*chosen == shell.name) print(shell.script(*sheave));
    }
    return ExitCode::done;
  };
}

}  // namespace sheave::command
