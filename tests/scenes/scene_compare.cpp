#include "tests/scenes/scene_compare.h"

#include <bit>
#include <sstream>

namespace sheave::test {
namespace {

/// Prints everything that a slot holds, numbers by their bits.
struct Print {
  std::ostringstream& out;

  void of(double x) const { out << std::hex << std::bit_cast<std::uint64_t>(x) << ' '; }
  void of(int x) const { out << x << ' '; }
  void of(bool x) const { out << x << ' '; }
  void of(const std::string& x) const { out << x.size() << x << ' '; }
  void of(BodyId x) const { out << x.index << ' '; }
  void of(const Vector3& x) const {
    for (const double c : x) of(c);
  }
  void of(const Quaternion& x) const {
    for (const double c : x.coeffs()) of(c);
  }
  template <class T>
  void operator()(const T* slot) const {
    of(*slot);
  }
  template <class T>
  void operator()(std::optional<T>* slot) const {
    out << slot->has_value() << ' ';
    if (*slot) of(**slot);
  }
  template <class T>
  void operator()(std::vector<T>* slot) const {
    out << slot->size() << ' ';
    for (const T& x : *slot) of(x);
  }
  void operator()(const ChoiceSlot& slot) const { out << slot.get(slot.object) << ' '; }
};

/// One line per field.
class Printer {
 public:
  void add(const std::string& path, std::span<const Field> fields, const void* object) {
    for (const Field& field : fields) {
      out_ << path << '/' << field.name << ' ';
      std::visit(Print{out_}, field.slot(const_cast<void*>(object)));
      out_ << '\n';
    }
  }
  template <class Base>
  void add_typed(const std::string& path, std::span<const TypeEntry<Base>> types,
                 const Base& object) {
    out_ << path << "/type " << object.type() << '\n';
    for (const auto& type : types) {
      if (type.name == object.type()) add(path, type.fields(), object.settings());
    }
  }
  void add(const Scene& scene) {
    add("", Scene::field_table(), &scene);
    add("/step", StepPresetDef::field_table(), &scene.step_preset);
    add("/step", StepSettings::field_table(), &scene.model.step);
    for (const BodyDef& body : scene.model.bodies) {
      add("/body", BodyDef::field_table(), &body);
      for (const PlacedShape& placed : body.shapes) {
        add("/body/shape", PlacedShape::field_table(), &placed);
        add_typed("/body/shape", shape_types(), *placed.shape);
      }
    }
    for (const auto& joint : scene.model.joints) {
      add("/joint", JointDef::common_field_table(), joint.get());
      add_typed("/joint", joint_types(), *joint);
    }
    for (const CableDef& cable : scene.cables) {
      add("/cable", CableDef::field_table(), &cable);
      for (const auto& link : cable.links) {
        add("/cable/link", LinkDef::common_field_table(), link.get());
        add_typed("/cable/link", link_types(), *link);
      }
    }
    for (const auto& controller : scene.controllers) {
      add("/controller", ControllerDef::common_field_table(), controller.get());
      add_typed("/controller", controller_types(), *controller);
    }
    for (const TriggerDef& trigger : scene.triggers) {
      add("/trigger", TriggerDef::field_table(), &trigger);
    }
    if (scene.model.ground) add("/ground", GroundDef::field_table(), &*scene.model.ground);
    if (scene.camera) add("/camera", CameraDef::field_table(), &*scene.camera);
    for (const CameraKeyDef& key : scene.camera_path) {
      add("/camera_path", CameraKeyDef::field_table(), &key);
    }
    for (const ParameterDef& own : scene.model.parameters) {
      add("/parameters", ParameterDef::field_table(), &own);
    }
    for (const AnnotationDef& text : scene.annotations) {
      add("/annotations", AnnotationDef::field_table(), &text);
    }
    for (const PaintDef& paint : scene.paint) add("/paint", PaintDef::field_table(), &paint);
    for (const CheckDef& check : scene.checks) add("/check", CheckDef::field_table(), &check);
  }
  [[nodiscard]] std::string text() const { return out_.str(); }

 private:
  std::ostringstream out_;
};

}  // namespace

std::string difference(const Scene& a, const Scene& b) {
  Printer print_a;
  Printer print_b;
  print_a.add(a);
  print_b.add(b);
  std::istringstream lines_a(print_a.text());
  std::istringstream lines_b(print_b.text());
  for (std::string line_a, line_b;;) {
    const bool more_a = static_cast<bool>(std::getline(lines_a, line_a));
    const bool more_b = static_cast<bool>(std::getline(lines_b, line_b));
    if (!more_a && !more_b) return {};
    if (more_a != more_b || line_a != line_b) return line_a + "\n" + line_b;
  }
}

}  // namespace sheave::test
