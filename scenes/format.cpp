#include "scenes/format.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "engine/field_check.h"
#include "engine/math/bits.h"
#include "scenes/format_tables.h"
#include "scenes/placement.h"
#include "scenes/scene.h"

namespace sheave {
namespace {

template <class Type>
ObjectFormat plain_format(std::string_view name, std::string_view meaning) {
  return {name, meaning, false, {table_of<Type>()}, {}, {}, {}};
}

bool same_bits(double a, double b) { return bits_of(a) == bits_of(b); }
template <class Derived>
bool same_bits(const Eigen::MatrixBase<Derived>& a, const Eigen::MatrixBase<Derived>& b) {
  for (Eigen::Index i = 0; i < a.size(); ++i) {
    if (!same_bits(a(i), b(i))) return false;
  }
  return true;
}
bool same_bits(const Quaternion& a, const Quaternion& b) {
  return same_bits(a.coeffs(), b.coeffs());
}
bool same_bits(int a, int b) { return a == b; }
bool same_bits(bool a, bool b) { return a == b; }
bool same_bits(const std::string& a, const std::string& b) { return a == b; }
bool same_bits(BodyId a, BodyId b) { return a == b; }
template <class T>
bool same_bits(const std::optional<T>& a, const std::optional<T>& b) {
  return a.has_value() == b.has_value() && (!a || same_bits(*a, *b));
}
template <class T>
bool same_bits(const std::vector<T>& a, const std::vector<T>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const T& x, const T& y) { return same_bits(x, y); });
}

/// Descriptions of the values that each type of slot accepts.
struct Description {
  const Field& field;

  [[nodiscard]] std::string numeric(std::string_view what) const {
    const std::string range = range_text(field.range);
    std::string text(what);
    if (!range.empty()) text += " " + range;
    if (!field.unit.empty()) text += fmt::format(" [{}]", field.unit);
    return text;
  }
  std::string operator()(const double*) const { return numeric("a number"); }
  std::string operator()(const std::optional<double>*) const { return numeric("a number"); }
  std::string operator()(const int*) const { return numeric("an integer"); }
  std::string operator()(const bool*) const { return "true or false"; }
  std::string operator()(const std::string*) const { return "a string"; }
  std::string operator()(const Vector3*) const { return numeric("[x, y, z], numbers"); }
  std::string operator()(const std::optional<Vector3>*) const {
    return numeric("[x, y, z], numbers");
  }
  std::string operator()(const Quaternion*) const { return "a unit quaternion [w, x, y, z]"; }
  std::string operator()(const BodyId*) const { return "the name of a body, or \"world\""; }
  std::string operator()(const std::optional<BodyId>*) const {
    return "the name of a body, or \"world\"";
  }
  std::string operator()(const std::vector<double>*) const { return numeric("a list of numbers"); }
  std::string operator()(const std::vector<Vector3>*) const {
    return numeric("a list of [x, y, z], numbers");
  }
  std::string operator()(const std::vector<std::string>*) const { return "a list of strings"; }
  std::string operator()(const ChoiceSlot&) const {
    std::string text;
    for (const std::string_view choice : field.choices) {
      text += fmt::format("{}\"{}\"", text.empty() ? "" : ", ", choice);
    }
    return text;
  }
};

}  // namespace

const Variant* ObjectFormat::variant(std::string_view type) const {
  const auto found = std::find_if(variants.begin(), variants.end(),
                                  [&](const Variant& v) { return v.name == type; });
  return found == variants.end() ? nullptr : &*found;
}

const Member* ObjectFormat::member(std::string_view key) const {
  const auto found =
      std::find_if(members.begin(), members.end(), [&](const Member& m) { return m.name == key; });
  return found == members.end() ? nullptr : &*found;
}

const ObjectFormat& scene_format() {
  static const ObjectFormat format{
      "scene",
      "a model, its cables, controls, checks and settings of pictures",
      false,
      {table_of<Scene>()},
      {},
      {{"step", "accuracy against cost", false, &step_format()},
       {"parameters", "named numbers for expressions", true, &parameter_format()},
       {"bodies", "rigid bodies", true, &body_format()},
       {"joints", "joints between two bodies", true, &joint_format()},
       {"cables", "cables", true, &cable_format()},
       {"controllers", "controllers, which lead observables to setpoints", true,
        &controller_format()},
       {"triggers", "triggers, which act at a time or once a condition holds", true,
        &trigger_format()},
       {"loads", "forces, winds and motions of bodies over time", true, &load_format()},
       {"colliders", "bodies that touch each other; absent: no bodies do", true,
        &collider_format()},
       {"ground",
        "a rigid floor for all bodies with shapes, without friction and rebound, whatever their "
        "colliders have: these act on the half-space of a fixed body; absent: none",
        false, &ground_format()},
       {"camera", "where pictures are taken from; absent: chosen automatically", false,
        &camera_format()},
       {"camera_path", "keyframes of the camera of films and pages; absent: the camera stands",
        true, &camera_key_format()},
       {"annotations", "texts and arrows in pictures, films and pages", true, &annotation_format()},
       {"paint", "colours of bodies in pictures; absent: chosen by the kind of each body", true,
        &paint_format()},
       {"checks", "values that the scene should show", true, &check_format()}},
      {}};
  return format;
}

const ObjectFormat& step_format() {
  static const ObjectFormat format{"step", "how the scene is stepped through time",
                                   false,  {table_of<StepPresetDef>(), table_of<StepSettings>()},
                                   {},     {},
                                   {}};
  return format;
}

const ObjectFormat& parameter_format() {
  static const ObjectFormat format{
      "parameter", "a named number that expressions may use, and --param sets",
      true,        {table_of<ParameterDef>()},
      {},          {},
      {}};
  return format;
}

const ObjectFormat& body_format() {
  static const ObjectFormat format{
      "body",
      "a rigid body",
      true,
      {table_of<BodyDef>(), table_of<BodyPlacementDef>()},
      {},
      {{"rotation", "the orientation as a turn in degrees; excludes orientation", false,
        &rotation_format()},
       {"shape", "the body's form, if it is one shape; excludes shapes", false, &shape_format()},
       {"shapes", "the body's form, if it is several shapes", true, &shape_format()}},
      {{"shape", "shapes"}, {"orientation", "rotation"}}};
  return format;
}

const ObjectFormat& shape_format() {
  static const ObjectFormat format{
      "shape",
      "a solid form",
      false,
      {table_of<PlacedShape>()},
      variants_of(shape_types()),
      {{"rotation", "the orientation as a turn in degrees; excludes orientation", false,
        &rotation_format()}},
      {{"orientation", "rotation"}}};
  return format;
}

const ObjectFormat& joint_format() {
  static const ObjectFormat format{"joint",
                                   "a joint between two bodies",
                                   true,
                                   {common_table(joint_types()), table_of<JointPlacementDef>()},
                                   variants_of(joint_types()),
                                   {},
                                   {}};
  return format;
}

const ObjectFormat& collider_format() {
  static const ObjectFormat format =
      plain_format<ColliderDef>("collider", "makes a body touch others, with the shapes it has");
  return format;
}

const ObjectFormat& ground_format() {
  static const ObjectFormat format = plain_format<GroundDef>("ground", "a flat immovable floor");
  return format;
}

const ObjectFormat& cable_format() {
  static const ObjectFormat format{
      "cable",
      "a cable: an ordered list of links",
      true,
      {table_of<CableDef>()},
      {},
      {{"links", "contacts of the cable with bodies, in order; at least 2", true, &link_format()}},
      {}};
  return format;
}

const ObjectFormat& link_format() {
  static const ObjectFormat format{"link",
                                   "one contact of a cable with a body",
                                   false,
                                   {common_table(link_types())},
                                   variants_of(link_types()),
                                   {},
                                   {}};
  return format;
}

const ObjectFormat& controller_format() {
  static const ObjectFormat format{"controller",
                                   "leads an observable to a setpoint",
                                   true,
                                   {common_table(controller_types())},
                                   variants_of(controller_types()),
                                   {},
                                   {}};
  return format;
}

const ObjectFormat& load_format() {
  static const ObjectFormat format{
      "load",
      "acts on a body over time, or prescribes its motion; or is a muscle along a cable",
      true,
      {common_table(load_types())},
      variants_of(load_types()),
      {},
      {}};
  return format;
}

const ObjectFormat& trigger_format() {
  static const ObjectFormat format{
      "trigger", "acts at a time or once a condition holds", true, {table_of<TriggerDef>()}, {}, {},
      {}};
  return format;
}

const ObjectFormat& camera_format() {
  static const ObjectFormat format =
      plain_format<CameraDef>("camera", "where pictures are taken from");
  return format;
}

const ObjectFormat& camera_key_format() {
  static const ObjectFormat format = plain_format<CameraKeyDef>(
      "camera key", "a pose of the camera at a time; the camera moves smoothly between two poses");
  return format;
}

const ObjectFormat& annotation_format() {
  static const ObjectFormat format =
      plain_format<AnnotationDef>("annotation", "a text in pictures, films and pages");
  return format;
}

const ObjectFormat& paint_format() {
  static const ObjectFormat format =
      plain_format<PaintDef>("paint", "the colour of a body in pictures");
  return format;
}

const ObjectFormat& check_format() {
  static const ObjectFormat format =
      plain_format<CheckDef>("check", "a value that the scene should show, with a tolerance");
  return format;
}

bool is_name(std::string_view text) {
  if (text.empty() || text.size() > 128 || text.front() == ' ' || text.back() == ' ') return false;
  return std::all_of(text.begin(), text.end(), [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' ||
           c == '-' || c == ' ';
  });
}

FieldSlot slot_of(const Field& field, const void* object) {
  // A slot gives write access, which the loader needs. Code that only reads uses this function.
  return field.slot(const_cast<void*>(object));  // NOLINT(cppcoreguidelines-pro-type-const-cast)
}

bool same_value(const Field& field, const void* a, const void* b) {
  const FieldSlot slot_b = slot_of(field, b);
  return std::visit(
      [&]<class Slot>(const Slot& slot_a) {
        const Slot& other = std::get<Slot>(slot_b);
        if constexpr (std::is_same_v<Slot, ChoiceSlot>) {
          return slot_a.get(slot_a.object) == other.get(other.object);
        } else {
          return same_bits(*slot_a, *other);
        }
      },
      slot_of(field, a));
}

void copy_value(const Field& field, const void* from, void* to) {
  const FieldSlot target = field.slot(to);
  std::visit(
      [&]<class Slot>(const Slot& source) {
        const Slot& slot = std::get<Slot>(target);
        if constexpr (std::is_same_v<Slot, ChoiceSlot>) {
          slot.set(slot.object, source.get(source.object));
        } else {
          *slot = *source;
        }
      },
      slot_of(field, from));
}

bool is_absent(const FieldSlot& slot) {
  return std::visit(
      []<class Slot>(const Slot& s) {
        if constexpr (requires { s->has_value(); }) {
          return !s->has_value();
        } else if constexpr (std::is_same_v<Slot, Quaternion*>) {
          return s->coeffs().isZero(0.0);
        } else if constexpr (std::is_same_v<Slot, ChoiceSlot>) {
          return s.may_be_absent && s.get(s.object) == ChoiceSlot::absent;
        } else {
          return false;
        }
      },
      slot);
}

std::string describe(const Field& field, const FieldSlot& slot) {
  return std::visit(Description{field}, slot);
}

std::string range_text(const Range& range) {
  const bool low = std::isfinite(range.minimum);
  const bool high = std::isfinite(range.maximum);
  const auto text_of = [](double bound) {  // 100000 rather than 1e+05
    const bool plain = bound == std::floor(bound) && std::abs(bound) < 1e9;
    return plain ? fmt::format("{:.0f}", bound) : number_text(bound);
  };
  const std::string minimum = text_of(range.minimum);
  const std::string maximum = text_of(range.maximum);
  if (low && high && range.minimum_allowed && range.maximum_allowed) {
    return minimum + " ... " + maximum;
  }
  std::string text;
  if (low) text += (range.minimum_allowed ? ">= " : "> ") + minimum;
  if (low && high) text += " and ";
  if (high) text += (range.maximum_allowed ? "<= " : "< ") + maximum;
  return text;
}

}  // namespace sheave
