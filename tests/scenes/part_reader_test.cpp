// Parts that are read by themselves, with the bodies that somebody has told.

#include "scenes/part_reader.h"

#include <gmock/gmock.h>

#include "scenes/format_tables.h"

namespace sheave {
namespace {

using json::Document;
using json::Faults;
using json::Limits;
using testing::HasSubstr;

/// A text, its faults and a reader of it.
struct Reading {
  Faults faults;
  Document document;
  PartReader parts;
  explicit Reading(const std::string& text)
      : document(Document::parse(text, "test", Limits{}, faults)), parts(document, faults) {}
  [[nodiscard]] std::vector<json::Fault> told() const { return faults.in_order(); }
};

TEST(PartReader, ReferencesAreTheDeclaredNumbers) {
  Reading reading(
      R"({"type": "ball", "name": "b", "body_a": "one", "body_b": "two", "anchor": [1, 2, 3]})");
  reading.parts.fields().declare_body("one", 7);
  reading.parts.fields().declare_body("two", 1);
  reading.parts.fields().declare_body("two", 12);  // another one of that name
  const std::shared_ptr<JointDef> joint = reading.parts.read_joint(reading.document.root());
  EXPECT_TRUE(reading.told().empty());
  ASSERT_NE(joint, nullptr);
  EXPECT_EQ(joint->body_a.index, 7);
  EXPECT_EQ(joint->body_b.index, 12);
}

TEST(PartReader, ForgottenNamesAreNeitherFoundNorSuggested) {
  Reading reading(R"({"body": "crate"})");
  reading.parts.fields().declare_body("crate", 0);
  reading.parts.fields().declare_body("crane", 1);
  reading.parts.fields().forget_body("crate");
  static_cast<void>(reading.parts.read_collider(reading.document.root()));
  ASSERT_EQ(reading.told().size(), 1U);
  EXPECT_EQ(reading.told()[0].code, FaultCode::unknown_body);
  EXPECT_EQ(reading.told()[0].pointer, "/body");
  EXPECT_THAT(reading.told()[0].message, HasSubstr("did you mean \"crane\"?"));
  Reading again(R"({"body": "crats"})");
  again.parts.fields().declare_body("crate", 0);
  again.parts.fields().forget_body("crate");
  static_cast<void>(again.parts.read_collider(again.document.root()));
  EXPECT_THAT(again.told().at(0).message, testing::Not(HasSubstr("crate")));
}

TEST(PartReader, PartsAreReadCompletely) {
  Reading body(
      R"({"name": "b", "mass": 2, "shapes": [{"type": "sphere", "radius": 1}, {"type": "box", "size": [1, 2, 3]}]})");
  const BodyDef read = body.parts.read_body(body.document.root());
  EXPECT_EQ(read.name, "b");
  EXPECT_EQ(read.mass, 2.0);
  ASSERT_EQ(read.shapes.size(), 2U);
  EXPECT_EQ(read.shapes[1].shape->type(), "box");
  Reading cable(
      R"({"name": "c", "links": [{"type": "attachment", "body": "world", "point": [0, 1, 0]}, {"type": "nothing"}]})");
  EXPECT_EQ(cable.parts.read_cable(cable.document.root()).links.size(), 1U);
  ASSERT_EQ(cable.told().size(), 1U);
  EXPECT_EQ(cable.told()[0].pointer, "/links/1/type");
}

TEST(PartReader, ChangesKeepSettingsThatAreNotGiven) {
  ObjectFormat format = collider_format();
  format.partial = true;
  Reading reading(R"({"friction": 0.5, "restitution": null, "compliance": -1})");
  ColliderDef collider;
  collider.restitution = 0.3;
  const std::array<void*, 1> objects{&collider};
  EXPECT_TRUE(reading.parts.fields().read_object(reading.document.root(), format, objects));
  EXPECT_EQ(collider.friction, 0.5);
  EXPECT_EQ(collider.restitution, 0.3) << "what null means is the caller's";
  ASSERT_EQ(reading.told().size(), 1U) << "the body may be missing";
  EXPECT_EQ(reading.told()[0].pointer, "/compliance");
}

TEST(PartReader, PointersReferToTheText) {
  Reading one(R"({"body": {"shape": {"type": "sphere", "radius": 1}}})");
  EXPECT_EQ(pointer_in_text(one.document, "/body/shapes/0/radius"), "/body/shape/radius");
  EXPECT_EQ(pointer_in_text(one.document, "/body/shape/radius"), "/body/shape/radius");
  Reading list(R"({"shapes": [{"type": "sphere", "radius": 1}, {"type": "sphere", "radius": 1}]})");
  EXPECT_EQ(pointer_in_text(list.document, "/shape/radius"), "/shapes/0/radius");
  EXPECT_EQ(pointer_in_text(list.document, "/shapes/1/size"), "/shapes/1/size");
}

}  // namespace
}  // namespace sheave
