#include "scenes/field_json.h"

namespace sheave {
namespace {

using Json = nlohmann::ordered_json;

/// One overload per type of slot.
struct ToJson {
  const Field& field;
  const BodyNamer& name_of;

  static Json of(double value) { return value; }
  static Json of(int value) { return value; }
  static Json of(bool value) { return value; }
  static Json of(const std::string& value) { return value; }
  static Json of(const Vector3& v) { return {v.x(), v.y(), v.z()}; }
  static Json of(const Quaternion& q) { return {q.w(), q.x(), q.y(), q.z()}; }
  [[nodiscard]] Json of(BodyId body) const { return name_of(body); }

  template <class T>
  Json operator()(T* slot) const {
    return of(*slot);
  }
  template <class T>
  Json operator()(std::optional<T>* slot) const {
    return slot->has_value() ? of(**slot) : Json();
  }
  template <class T>
  Json operator()(std::vector<T>* slot) const {
    Json list = Json::array();
    for (const T& element : *slot) list.push_back(of(element));
    return list;
  }
  Json operator()(const ChoiceSlot& slot) const {
    const auto index = static_cast<std::size_t>(slot.get(slot.object));
    return index < field.choices.size() ? Json(field.choices[index]) : Json();
  }
};

}  // namespace

nlohmann::ordered_json field_json(const Field& field, const FieldSlot& slot,
                                  const BodyNamer& name_of) {
  const ToJson to_json{field, name_of};
  return std::visit([&](const auto& s) { return to_json(s); }, slot);
}

}  // namespace sheave
