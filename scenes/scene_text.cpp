#include "scenes/scene_text.h"

#include <fmt/format.h>

#include "engine/field_check.h"
#include "scenes/json/document.h"

namespace sheave {
namespace {

std::string quoted(std::string_view word) { return fmt::format("\"{}\"", word); }

/// Position of a new member of an object, and the text before it.
struct Gap {
  std::uint32_t offset = 0;
  std::string_view separator;
};

Gap gap_in(const json::Document& document, json::NodeId object) {
  const auto members = document.children(object);
  if (members.empty()) return {document.offset(object) + 1, ""};
  const bool outermost = object == document.root();
  return {document.end_offset(members.back()), outermost ? ",\n  " : ", "};
}

}  // namespace

Result<std::string> with_setting(std::string_view text, std::string_view pointer,
                                 std::string_view value) {
  json::Faults faults;
  const json::Document document = json::Document::parse(text, "scene", {}, faults);
  if (document.root() == json::no_node || !faults.empty()) {
    const auto list = faults.in_order();
    return Error{"", list.empty() ? "the text is not JSON" : list.front().message};
  }
  std::string result(text);
  const json::Document::Target target = document.find(pointer);
  if (target.exact) {
    const std::uint32_t begin = document.offset(target.node);
    return result.replace(begin, document.end_offset(target.node) - begin, value);
  }
  const std::size_t slash = pointer.rfind('/');
  if (slash == std::string_view::npos) return Error{std::string(pointer), "not a JSON pointer"};
  const std::string_view parent = pointer.substr(0, slash);
  const std::string member = quoted(pointer.substr(slash + 1)) + ": " + std::string(value);
  const json::Document::Target object = document.find(parent);
  if (!object.exact && parent == "/step") {
    return with_setting(text, parent, "{" + member + "}");
  }
  if (!object.exact || document.kind(object.node) != json::Kind::object) {
    return Error{std::string(pointer), "there is no object to hold it"};
  }
  const Gap gap = gap_in(document, object.node);
  return result.insert(gap.offset, std::string(gap.separator) + member);
}

std::vector<Override> step_changes(const Scene& from, const Scene& to) {
  std::vector<Override> changes;
  const auto add = [&](bool changed, std::string pointer, std::string value) {
    if (changed) changes.push_back({std::move(pointer), std::move(value), {}});
  };
  const StepSettings& old = from.model.step;
  const StepSettings& step = to.model.step;
  add(old.dt != step.dt, "/step/dt", number_text(step.dt));
  const bool fixed = step.tolerance == 0.0;
  add(!fixed && old.tolerance != step.tolerance, "/step/tolerance", number_text(step.tolerance));
  add(fixed && (old.substeps != step.substeps || old.tolerance > 0.0), "/step/substeps",
      fmt::format("{}", step.substeps));
  add(old.iterations != step.iterations, "/step/iterations", fmt::format("{}", step.iterations));
  add(old.solver != step.solver, "/step/solver",
      quoted(solver_names[static_cast<std::size_t>(step.solver)]));
  add(old.integrator != step.integrator, "/step/integrator",
      quoted(integrator_names[static_cast<std::size_t>(step.integrator)]));
  for (std::size_t i = 0; i < to.cables.size(); ++i) {
    const TangentUpdate update = to.cables[i].tangent_update;
    add(from.cables[i].tangent_update != update, fmt::format("/cables/{}/tangent_update", i),
        quoted(tangent_update_names[static_cast<std::size_t>(update)]));
  }
  return changes;
}

}  // namespace sheave
