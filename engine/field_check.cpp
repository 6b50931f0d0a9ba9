#include "engine/field_check.h"

namespace sheave {
namespace {

/// Checks the numbers of one field, or the number of its choice. Paths are made on failure only, because a scene may have a
/// million bodies.
class NumberCheck {
 public:
  NumberCheck(const Field& field, const std::string& path, Errors& errors)
      : field_(field), path_(path), errors_(errors) {}

  // Pointers to const would select the template below, which is for fields without numbers.
  // NOLINTBEGIN(readability-non-const-parameter)
  void operator()(double* value) const { check(*value); }
  void operator()(int* value) const { check(*value); }
  void operator()(Vector3* value) const { check_components(*value); }
  void operator()(Quaternion* value) const {
    const double norm = value->norm();
    if (std::abs(norm - 1.0) <= 1e-6) return;  // rounding error of six printed decimals
    errors_.push_back({place(none, none), std::string(field_.name) +
                                              " must be a unit quaternion [w, x, y, z]; "
                                              "its length is " +
                                              number_text(norm)});
  }
  void operator()(std::optional<double>* value) const {
    if (*value) check(**value);
  }
  void operator()(std::optional<Vector3>* value) const {
    if (*value) check_components(**value);
  }
  void operator()(std::vector<double>* value) const {
    for (std::size_t i = 0; i < value->size(); ++i) check((*value)[i], i);
  }
  void operator()(std::vector<Vector3>* value) const {
    for (std::size_t i = 0; i < value->size(); ++i) check_components((*value)[i], i);
  }
  // NOLINTEND(readability-non-const-parameter)
  void operator()(const ChoiceSlot& slot) const {
    const int index = slot.get(slot.object);
    if (slot.may_be_absent && index == ChoiceSlot::absent) return;
    if (index >= 0 && static_cast<std::size_t>(index) < field_.choices.size()) return;
    std::string known;
    for (const std::string_view choice : field_.choices) {
      known += (known.empty() ? "" : ", ") + std::string(choice);
    }
    errors_.push_back({place(none, none), std::string(field_.name) + " has no value number " +
                                              std::to_string(index) + "; the values from 0 are " +
                                              known});
  }
  template <class Other>
  void operator()(const Other& /*no number*/) const {}

 private:
  static constexpr std::size_t none = static_cast<std::size_t>(-1);

  /// Path of the field, of an item in it, or of a component of that item.
  [[nodiscard]] std::string place(std::size_t item, std::size_t component) const {
    std::string result = path_ + "/" + std::string(field_.name);
    for (const std::size_t index : {item, component}) {
      if (index != none) result += "/" + std::to_string(index);
    }
    return result;
  }
  void check_components(const Vector3& value, std::size_t item = none) const {
    for (int i = 0; i < 3; ++i) check(value[i], item, static_cast<std::size_t>(i));
  }
  void check(double value, std::size_t item = none, std::size_t component = none) const {
    if (field_.range.contains(value)) return;
    errors_.push_back(
        {place(item, component), std::string(field_.name) + " is " + number_text(value) +
                                     "; it must be " + describe(field_.range) +
                                     (field_.unit.empty() ? "" : " " + std::string(field_.unit))});
  }

  const Field& field_;
  const std::string& path_;
  Errors& errors_;
};

}  // namespace

std::string describe(const Range& range) {
  const bool has_minimum = std::isfinite(range.minimum);
  const bool has_maximum = std::isfinite(range.maximum);
  const std::string low =
      (range.minimum_allowed ? "at least " : "greater than ") + number_text(range.minimum);
  const std::string high =
      (range.maximum_allowed ? "at most " : "less than ") + number_text(range.maximum);
  if (has_minimum && has_maximum) return low + " and " + high;
  if (has_minimum) return low;
  if (has_maximum) return high;
  return "a finite number";
}

void check_fields(std::span<const Field> fields, const void* object, const std::string& path,
                  Errors& errors) {
  for (const Field& field : fields) {
    // Reading and writing share the slots; this function writes nothing.
    // NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    std::visit(NumberCheck(field, path, errors), field.slot(const_cast<void*>(object)));
  }
}

}  // namespace sheave
