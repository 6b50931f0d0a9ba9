// Prints a dictionary for libFuzzer: the words of scenes, from the field tables. The argument
// "live" selects the words of live requests, and "command_line" those of the command line, from its
// options.

#include <algorithm>
#include <cstdio>
#include <set>
#include <string>
#include <string_view>

#if SHEAVE_HAS_COMMAND
#include <CLI/CLI.hpp>

#include "command/registry.h"
#endif
#include "live/request_format.h"
#include "scenes/format.h"

namespace sheave::fuzz {
namespace {

using Words = std::set<std::string>;

void add_table(const TableFormat& table, Words& words) {
  for (const Field& field : table.fields) {
    words.insert("\"" + std::string(field.name) + "\": ");
    for (const std::string_view choice : field.choices) {
      words.insert("\"" + std::string(choice) + "\"");
    }
  }
}

void add_format(const ObjectFormat& format, std::set<const ObjectFormat*>& seen, Words& words) {
  if (!seen.insert(&format).second) return;
  const auto add_members = [&](const std::vector<Member>& members) {
    for (const Member& member : members) {
      words.insert("\"" + std::string(member.name) + (member.list ? "\": [" : "\": {"));
      add_format(*member.format, seen, words);
    }
  };
  for (const TableFormat& table : format.tables) add_table(table, words);
  for (const Variant& variant : format.variants) {
    words.insert("\"type\": \"" + std::string(variant.name) + "\"");
    add_table(variant.table, words);
    add_members(variant.members);
  }
  add_members(format.members);
}

/// Parts of expressions of quantities.
void add_expressions(Words& words) {
  for (const char* part : {"t", "hypot(", "max(", "if(", "atan2(", ", ", ")", " - ", "<=", "^",
                           "[m/s]", "'", "pi", "1e-3"}) {
    words.insert(part);
  }
}

Words scene_words() {
  Words words{"null", "true", "false", "\"world\"", "1e308", "-1", "[0, 0, 1]", "//", "/*", "*/"};
  add_expressions(words);
  std::set<const ObjectFormat*> seen;
  add_format(scene_format(), seen, words);
  return words;
}

Words live_words() {
  Words words{"null",      "true",     "1e308",    "-1",       "\n",
              "\"start\"", "\"load\"", "\"rope\"", "\"brake\""};
  add_expressions(words);
  std::set<const ObjectFormat*> seen;
  for (const ObjectFormat& format : live::request_formats()) add_format(format, seen, words);
  return words;
}

#if SHEAVE_HAS_COMMAND
void add_app(const CLI::App& app, Words& words) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) words.insert("--" + name + "\n");
    for (const std::string& name : option->get_snames()) words.insert("-" + name + "\n");
  }
  for (const CLI::App* child : app.get_subcommands([](const CLI::App*) { return true; })) {
    words.insert(child->get_name() + "\n");
    add_app(*child, words);
  }
}

Words command_line_words() {
  Words words{"nan", "inf", "-1", "1e999", "--set\n/bodies/0/mass=", "/step/dt=", "=", "\n--\n"};
  const command::CommandLine line;
  add_app(*line.app, words);
  return words;
}
#else
Words command_line_words() { return {}; }
#endif

void print(const Words& words) {
  std::string text;
  for (const std::string& word : words) {
    text += '"';
    for (const char c : word) {
      if (c == '\n') {
        text += "\\x0A";
      } else {
        if (c == '"' || c == '\\') text += '\\';
        text += c;
      }
    }
    text += "\"\n";
  }
  std::fputs(text.c_str(), stdout);
}

Words words_of(std::string_view kind) {
  if (kind == "command_line") return command_line_words();
  return kind == "live" ? live_words() : scene_words();
}

}  // namespace
}  // namespace sheave::fuzz

int main(int argc, char** argv) {
  sheave::fuzz::print(sheave::fuzz::words_of(argc > 1 ? argv[1] : "scene"));
  return 0;
}
