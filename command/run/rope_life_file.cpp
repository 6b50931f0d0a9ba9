// Reads the formulas of a rope's life.

#include <fmt/format.h>

#include "command/failure.h"
#include "command/input/file.h"
#include "command/input/json_check.h"
#include "command/run/rope_files.h"

namespace sheave::command {
namespace {

constexpr std::string_view life_format = "sheave-rope-life/1";
constexpr std::size_t most_life_bytes = std::size_t{1} << 20U;

measure::RopeLifeFormulas formulas_of(const json::Document& document) {
  measure::RopeLifeFormulas formulas;
  const auto members = [&](std::string_view key) {
    const json::NodeId node = document.member(document.root(), key);
    return node == json::no_node ? std::span<const json::NodeId>() : document.children(node);
  };
  const auto text = [&](std::string_view key) {
    const json::NodeId node = document.member(document.root(), key);
    return node == json::no_node ? std::string() : document.string(node);
  };
  for (const json::NodeId node : members("constants")) {
    formulas.constants.emplace_back(document.key(node), document.number(node));
  }
  for (const json::NodeId node : members("definitions")) {
    formulas.definitions.emplace_back(document.key(node), document.string(node));
  }
  formulas.simple_bends = text("simple_bends");
  formulas.reverse_bends = text("reverse_bends");
  return formulas;
}

[[noreturn]] void fail_formulas(const json::Document& document, const std::string& path,
                                const Errors& errors) {
  std::string text;
  for (const Error& error : errors) {
    const json::NodeId node = document.find(error.path).node;
    const json::Location place = document.location(document.offset(node));
    if (!text.empty()) text += '\n';
    text +=
        fmt::format("{}:{}:{}: {}: {}", path, place.line, place.column, error.path, error.message);
  }
  throw Failure(ExitCode::bad_scene, text);
}

}  // namespace

measure::RopeLife read_rope_life(const std::string& path, double rope_diameter) {
  constexpr double largest = 1e100;
  const std::string text = read_input(path, most_life_bytes);
  check_json(text, path, life_format,
             json_object({{"format", json_text()},
                          {"constants", json_map(json_number(-largest, largest)), false},
                          {"definitions", json_map(json_text()), false},
                          {"simple_bends", json_text()},
                          {"reverse_bends", json_text(), false}}));
  const json::Document document = read_json(text, path);
  Result<measure::RopeLife> life = measure::RopeLife::create(formulas_of(document), rope_diameter);
  if (!life) fail_formulas(document, path, life.errors());
  return std::move(life).value();
}

}  // namespace sheave::command
