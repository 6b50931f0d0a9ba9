// Reference documentation of the format, from the tables.

#include "scenes/reference.h"

#include <algorithm>

#include <fmt/format.h>

#include "scenes/control/control_point.h"
#include "scenes/field_json.h"
#include "scenes/format.h"
#include "scenes/json/pretty.h"
#include "scenes/observables.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

constexpr std::string_view introduction = R"(# The scene format

<!-- Made from the field tables of the sources; do not edit. -->

A scene is a JSON file with `//` and `/* */` comments. Units are SI. Vectors are `[x, y, z]`;
quaternions are `[w, x, y, z]` and unit. Bodies refer to each other by name; `"world"` is the
immovable world. A key that is not listed here is an error, and so is a key given twice.
Names of bodies, joints and cables consist of )";

constexpr std::string_view quantities_text = R"(
## Quantities

Quantities that a check may name. They are also the columns of a CSV file:

| quantity | unit | meaning |
|---|---|---|
| `t` | s | time |
)";

constexpr std::string_view requested_quantities = R"(
### On request

Further quantities that a check may name. They are columns only if `--columns` names them, because they take longer to compute.
Forces and powers are means over the last substep.

| quantity | unit | meaning |
|---|---|---|
)";

constexpr std::string_view expressions = R"(
### Expressions

Wherever a quantity is named, an expression of quantities may stand: `hook.x - trolley.x`, `hypot(a.x - b.x, a.y - b.y)`.

| | in the order of precedence, the last first |
|---|---|
| `<` `<=` `>` `>=` `==` `!=` | 1 if it holds, 0 if not |
| `+` `-` | operands of one unit; `2 * angle * radius - x` is possible, since radians vanish beside metres |
| `*` `/` | |
| `-a` `+a` | |
| `a ^ b` | from the right; `-a ^ 2` is `-(a ^ 2)` |
| `abs(a)` `sqrt(a)` `min(a, b, ...)` `max(a, b, ...)` `hypot(a, b, ...)` | min and max of values at one moment |
| `max(a)` `min(a)` `mean(a)` `range(a)` `rate(a)` `drift(a)` `integral(a)` | of one operand: statistics over time, as those of checks, from the start of the run up to now |
| `max: a - b` | the same as `max(a - b)`: a statistic of all up to the end, the comma or the parenthesis |
| `sin(a)` `cos(a)` `tan(a)` `exp(a)` `log(a)` | of angles [rad] and pure numbers |
| `asin(a)` `acos(a)` `atan(a)` `atan2(y, x)` | angles [rad] |
| `if(condition, a, b)` | `a` where the condition is not 0, else `b` |
| `2`, `1.5e-3`, `pi` | numbers; in sums and comparisons they take the unit of the other side, elsewhere they are pure |
| `/bodies/load/mass`, `/gravity/1` | a number among the settings of the scene, by its pointer as in `--set`, with defaults and with its unit: of drives that of their kind, of triggers and controllers that of the quantity or the control |
| `limit` | the parameter of the scene with this name, with its unit |
| `2[rad/s]` | a number with a unit of m, kg, s, rad, N, J, W and Hz: `sin(2[rad/s] * t)` |

Names may have spaces and hyphens: the longest name that fits is taken, so `my-rope.0.tension / 2` divides a tension. A text that is a
whole name is always that quantity. Where a longer text could mean a name with a hyphen or a difference, it is refused; quotes make it a
name, `'my-rope'.0.tension`, and spaces around the minus a difference. An expression has at most 1000 characters and 40 levels of nesting. Its
value is missing where one of its quantities is, or where a function has none, as `sqrt(-1)`. In Jsonnet a parameter becomes part of an
expression by `%`: `"load.y / %g" % height`.
)";

constexpr std::string_view controls = R"(
## Controls

Controls that a controller or a trigger may set. A control holds until it is set again or cleared, and is part of the state. A drive
to a speed reaches its target after a substep, a drive to an angle or a position when the controller may act again; a torque or a force acts
at once. A drive or a feed that a trigger sets reaches its target after the trigger's `over`; without `over` a speed is there at once.

| control | unit | meaning |
|---|---|---|
)";

/// Rows of the table of quantities; quantities with the same meaning share a row.
void append_quantities(std::span<const QuantityGroup> groups, std::string& text) {
  for (const QuantityGroup& group : groups) {
    const auto& quantities_of = group.quantities;
    for (std::size_t i = 0; i < quantities_of.size();) {
      std::string names = fmt::format("`{}{}`", group.prefix, quantities_of[i].name);
      const Quantity& first = quantities_of[i];
      std::string units(first.unit);
      for (++i; i < quantities_of.size() && quantities_of[i].help == "the same"; ++i) {
        names += fmt::format(", `.{}`", quantities_of[i].name);
        if (quantities_of[i].unit != first.unit)
          units += fmt::format(", {}", quantities_of[i].unit);
      }
      text += fmt::format("| {} | {} | {} |\n", names, units, first.help);
    }
  }
}

void append_codes(std::string& text) {
  text +=
      "\n## Codes\n\nCodes of the faults and warnings of `sheave validate --json`. A code never "
      "changes "
      "its "
      "meaning.\n\n| code | severity | meaning |\n|---|---|---|\n";
  for (const CodeEntry& entry : code_table()) {
    text += fmt::format("| `{}` | {} | {} |\n", entry.code, entry.severity, entry.meaning);
  }
}

/// Text in a cell of a table.
std::string cell(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '|') result += '\\';
    result += c;
  }
  return result;
}

std::string default_text(const Field& field, const FieldSlot& slot) {
  if (field.presence == Presence::required) return "required";
  if (is_absent(slot)) return "";
  const auto value = field_json(field, slot, [](BodyId) { return std::string("world"); });
  if (value.is_array() && value.empty()) return "";
  std::string text = json::pretty(value);
  text.pop_back();  // the line break
  return "`" + text + "`";
}

void add_table_head(std::string& text) {
  text += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
}

void add_fields(const TableFormat& table, std::string& text) {
  for (const Field& field : table.fields) {
    const FieldSlot slot = slot_of(field, table.defaults.get());
    text += fmt::format("| `{}` | {} | {} | {} |\n", field.name, cell(describe(field, slot)),
                        cell(default_text(field, slot)), cell(field.meaning));
  }
}

void add_members(std::span<const Member> members, std::string_view scene_page, std::string& text) {
  for (const Member& member : members) {
    const std::string_view page = is_in_scenes(*member.format) ? scene_page : std::string_view();
    text += fmt::format("| `{}` | {} [{}]({}#{}) | {}| {} |\n", member.name,
                        member.list ? "a list of" : "a", member.format->name, page,
                        anchor_of(member.format->name), member.required ? "required " : "",
                        cell(member.meaning));
  }
}

/// The formats in the order in which they are first mentioned.
void collect(const ObjectFormat& format, std::vector<const ObjectFormat*>& formats) {
  if (std::find(formats.begin(), formats.end(), &format) != formats.end()) return;
  formats.push_back(&format);
  for (const Member& member : format.members) collect(*member.format, formats);
}

}  // namespace

std::string anchor_of(std::string_view heading) {
  std::string anchor(heading);
  std::replace(anchor.begin(), anchor.end(), ' ', '-');
  return anchor;
}

bool is_in_scenes(const ObjectFormat& format) {
  static const std::vector<const ObjectFormat*> formats = [] {
    std::vector<const ObjectFormat*> found;
    collect(scene_format(), found);
    return found;
  }();
  return std::find(formats.begin(), formats.end(), &format) != formats.end();
}

void append_reference(const ObjectFormat& format, std::string& text, std::string_view scene_page) {
  text += fmt::format("\n## {}\n\n{}.\n", format.name, format.meaning);
  const auto has_fields = [](const TableFormat& table) { return !table.fields.empty(); };
  if (!format.variants.empty() || !format.members.empty() ||
      std::any_of(format.tables.begin(), format.tables.end(), has_fields)) {
    add_table_head(text);
  }
  if (!format.variants.empty()) text += "| `type` | one of the types below | required | |\n";
  for (const TableFormat& table : format.tables) add_fields(table, text);
  add_members(format.members, scene_page, text);
  for (const Variant& variant : format.variants) {
    text += fmt::format("\n### {} `\"{}\"`\n\n{}.\n", format.name, variant.name, variant.meaning);
    if (variant.table.fields.empty() && variant.members.empty()) continue;
    add_table_head(text);
    add_fields(variant.table, text);
    add_members(variant.members, scene_page, text);
  }
}

std::string scene_reference() {
  std::string text(introduction);
  text += name_rule;
  text += ".\n";
  std::vector<const ObjectFormat*> formats;
  collect(scene_format(), formats);
  for (const ObjectFormat* format : formats) append_reference(*format, text);
  text += quantities_text;
  append_quantities(quantity_groups(), text);
  text += requested_quantities;
  append_quantities(requested_quantity_groups(), text);
  text += expressions;
  text += controls;
  append_quantities(control_groups(), text);
  append_codes(text);
  return text;
}

}  // namespace sheave
