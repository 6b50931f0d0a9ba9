#include <random>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "scenes/json/document.h"

namespace sheave::json {
namespace {

struct Parsed {
  Faults faults;
  Document document;
  explicit Parsed(std::string_view text, const Limits& limits = {})
      : faults(limits.faults), document(Document::parse(text, "file.json", limits, faults)) {}
  [[nodiscard]] NodeId at(std::string_view pointer) const {
    const Document::Target target = document.find(pointer);
    return target.exact ? target.node : no_node;
  }
  [[nodiscard]] std::string place(std::string_view pointer) const {
    const Location l = document.location(document.offset(at(pointer)));
    return std::to_string(l.line) + ":" + std::to_string(l.column);
  }
  [[nodiscard]] std::string first_fault() const {
    if (faults.empty()) return "";
    const Fault fault = faults.in_order().front();
    const Location l = document.location(fault.offset);
    return std::to_string(l.line) + ":" + std::to_string(l.column) + " " + fault.pointer + " " +
           fault.message;
  }
};

TEST(JsonDocument, KnowsThePlaceOfEveryValue) {
  const Parsed p(
      "{\n  \"a\": [1, -2.5e3,\n    \"x\\\"y\"],  // comment, with: marks {\n"
      "  /* and\n another */ \"b\" : {\"c\": true, \"d\": null}\n}\n");
  ASSERT_TRUE(p.faults.empty()) << p.first_fault();
  EXPECT_EQ(p.place(""), "1:1");
  EXPECT_EQ(p.place("/a"), "2:8");
  EXPECT_EQ(p.place("/a/0"), "2:9");
  EXPECT_EQ(p.place("/a/1"), "2:12");
  EXPECT_EQ(p.place("/a/2"), "3:5");
  EXPECT_EQ(p.place("/b"), "5:19");
  EXPECT_EQ(p.place("/b/c"), "5:25");
  EXPECT_EQ(p.place("/b/d"), "5:36");
  EXPECT_EQ(p.document.excerpt(p.at("/a/1")), "-2.5e3");
  EXPECT_EQ(p.document.number(p.at("/a/1")), -2500.0);
  EXPECT_EQ(p.document.string(p.at("/a/2")), "x\"y");
  EXPECT_EQ(p.document.pointer(p.at("/a/2")), "/a/2");
  EXPECT_TRUE(p.document.boolean(p.at("/b/c")));
  const Location key = p.document.location(p.document.key_offset(p.at("/b/d")));
  EXPECT_EQ(key.column, 31);
  EXPECT_EQ(key.file, "file.json");
}

TEST(JsonDocument, ColumnsCountCharactersAndAByteOrderMarkIsSkipped) {
  const Parsed p("\xEF\xBB\xBF{\"\xC3\xA4\xE2\x82\xAC\": \"\xF0\x9F\x98\x80\", \"b\": 1}");
  ASSERT_TRUE(p.faults.empty()) << p.first_fault();
  // The mark itself counts as a character.
  EXPECT_EQ(p.place("/b"), "1:19");
}

TEST(JsonDocument, PointersEscapeSlashAndTilde) {
  const Parsed p(R"({"a/b": {"~": [5]}})");
  const NodeId node = p.at("/a~1b/~0/0");
  ASSERT_NE(node, no_node);
  EXPECT_EQ(p.document.pointer(node), "/a~1b/~0/0");
  EXPECT_FALSE(p.document.find("/a~1b/~0/1").exact);
  EXPECT_EQ(p.document.pointer(p.document.find("/a~1b/~0/1/x").node), "/a~1b/~0");
  EXPECT_FALSE(p.document.find("/a~1b/~0/00").exact);
}

TEST(JsonDocument, ReportsSyntaxErrorsWithTheirPlace) {
  using testing::HasSubstr;
  EXPECT_THAT(Parsed("[1,\n 2,, 3]").first_fault(), HasSubstr("2:4 /2 syntax error"));
  EXPECT_THAT(Parsed("{\"a\": 1\n\"b\": 2}").first_fault(), HasSubstr("expected ',' or '}'"));
  EXPECT_THAT(Parsed("{\"a\": 1e999}").first_fault(), HasSubstr("1:7 /a number too large"));
  EXPECT_THAT(Parsed("{\"a\": [0, 1e-999]}").first_fault(),
              HasSubstr("1:11 /a/1 number too small"));
  EXPECT_TRUE(Parsed("[0e-999, 0.0, -0.0, 5e-324]").faults.empty());
  EXPECT_THAT(Parsed(std::string_view("{}\0 rest", 8)).first_fault(), HasSubstr("null character"));
  EXPECT_THAT(Parsed("").first_fault(), HasSubstr("unexpected end of input"));
  EXPECT_THAT(Parsed("\"\\ud800\"").first_fault(), HasSubstr("invalid string"));
}

TEST(JsonDocument, ReportsEveryDuplicateKey) {
  const Parsed p("{\"a\": 1,\n\"b\": {\"x\": 1, \"x\": 2},\n\"a\": 2,\n\"a\": 3}");
  const auto faults = p.faults.in_order();
  ASSERT_EQ(faults.size(), 3U);
  EXPECT_EQ(faults[0].pointer, "/b/x");
  EXPECT_EQ(faults[1].pointer, "/a");
  EXPECT_EQ(p.document.location(faults[2].offset).line, 4);
  EXPECT_THAT(faults[2].message, testing::HasSubstr("first given in line 1"));
}

TEST(JsonDocument, DepthIsLimitedWithoutRecursion) {
  for (const char* open : {"[", "{\"a\":"}) {
    std::string text;
    for (int i = 0; i < 100'000; ++i) text += open;
    EXPECT_THAT(Parsed(text).first_fault(), testing::HasSubstr("nested more than 64 deep")) << open;
  }
  std::string deepest = std::string(64, '[') + std::string(64, ']');
  EXPECT_TRUE(Parsed(deepest).faults.empty());
  EXPECT_FALSE(Parsed("[" + deepest + "]").faults.empty());
}

TEST(JsonDocument, CountsAreLimitedBeforeMemoryIsTaken) {
  Limits limits;
  limits.values = 100;
  EXPECT_TRUE(Parsed("[" + std::string(96, ' ') + "1]", limits).faults.empty());
  std::string many = "[0";
  for (int i = 0; i < 100; ++i) many += ",0";
  EXPECT_THAT(Parsed(many + "]", limits).first_fault(), testing::HasSubstr("more than 100 values"));
  limits.bytes = 10;
  EXPECT_THAT(Parsed("[1, 2, 3, 4]", limits).first_fault(), testing::HasSubstr("at most 10"));
}

TEST(JsonDocument, FaultsBeyondTheLimitAreCounted) {
  Limits limits;
  limits.faults = 2;
  const Parsed p(R"({"a": 1, "a": 1, "a": 1, "a": 1, "a": 1})", limits);
  EXPECT_EQ(p.faults.in_order().size(), 2U);
  EXPECT_EQ(p.faults.omitted(), 2U);
}

class Setting : public testing::Test {
 protected:
  Parsed p{R"({"a": {"b": 1}, "list": [10, 20]})"};

  std::string set(std::string_view pointer, std::string_view value) {
    const std::array<std::string_view, 1> implied{"/step"};
    p.document.set(pointer, value, "--set", implied, {}, p.faults);
    return p.first_fault();
  }
};

TEST_F(Setting, ReplacesAndAdds) {
  EXPECT_EQ(set("/a/b", "[1, {\"c\": 2}]"), "");
  EXPECT_EQ(set("/a/b/1/c", "3"), "");
  EXPECT_EQ(set("/a/new", "true"), "");
  EXPECT_EQ(set("/list/1", "fast word"), "");
  EXPECT_EQ(set("/step/dt", "0.5"), "");
  EXPECT_EQ(p.document.number(p.at("/a/b/1/c")), 3.0);
  EXPECT_TRUE(p.document.boolean(p.at("/a/new")));
  EXPECT_EQ(p.document.string(p.at("/list/1")), "fast word");
  EXPECT_EQ(p.document.number(p.at("/list/0")), 10.0);
  EXPECT_EQ(p.document.number(p.at("/step/dt")), 0.5);
  EXPECT_EQ(p.document.pointer(p.at("/step/dt")), "/step/dt");
  EXPECT_EQ(p.document.location(p.document.offset(p.at("/a/new"))).file, "--set");
}

TEST_F(Setting, ReplacesTheWholeText) {
  EXPECT_EQ(set("", "[7]"), "");
  EXPECT_EQ(p.document.number(p.at("/0")), 7.0);
}

TEST_F(Setting, DoesNotInventParents) {
  EXPECT_THAT(set("/none/b", "1"), testing::HasSubstr("there is no /none"));
}
TEST_F(Setting, DoesNotExtendLists) {
  EXPECT_THAT(set("/list/2", "1"), testing::HasSubstr("2 elements"));
}
TEST_F(Setting, DoesNotEnterNumbers) {
  EXPECT_THAT(set("/a/b/c", "1"), testing::HasSubstr("is a number and has no members"));
}
TEST_F(Setting, NeedsAPointer) {
  EXPECT_THAT(set("a/b", "1"), testing::HasSubstr("must begin with"));
}
TEST_F(Setting, NeedsAValue) { EXPECT_THAT(set("/a/b", "1,"), testing::HasSubstr("syntax error")); }
TEST_F(Setting, TakesNoSignsForWords) {
  EXPECT_THAT(set("/a/b", "-x"), testing::HasSubstr("syntax error"));
}

/// Whatever is in a text, every token that the parser tells of is found where it stands.
TEST(JsonDocument, RandomTextsKeepCursorAndParserInStep) {
  std::mt19937 random(1);
  const auto pick = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto blank = [&] {
    static const std::array<std::string, 6> kinds{"",       " ",     "\n", "/* , : \" */",
                                                  "// [\n", "\t\r\n"};
    return kinds[static_cast<std::size_t>(pick(6))];
  };
  const std::function<std::string(int)> value = [&](int depth) -> std::string {
    static const std::array<std::string, 8> scalars{
        "1", "-2.5E+3", "true", "null", "\"\"", "\"a\\\\\"", "\"// \\\" , : {\"", "false"};
    if (depth == 0 || pick(3) == 0) return scalars[static_cast<std::size_t>(pick(8))];
    const bool object = pick(2) == 0;
    std::string text = object ? "{" : "[";
    const int count = pick(4);
    for (int i = 0; i < count; ++i) {
      if (i > 0) text += blank() + ",";
      text += blank();
      if (object) text += "\"k" + std::to_string(i) + "\"" + blank() + ":" + blank();
      text += value(depth - 1);
    }
    return text + blank() + (object ? "}" : "]");
  };
  const std::function<void(const Parsed&, NodeId)> check = [&](const Parsed& p, NodeId id) {
    const std::string text = p.document.excerpt(id);
    switch (p.document.kind(id)) {
      case Kind::null:
        EXPECT_EQ(text, "null");
        break;
      case Kind::boolean:
        EXPECT_EQ(text, p.document.boolean(id) ? "true" : "false");
        break;
      case Kind::number:
        EXPECT_EQ(std::stod(text), p.document.number(id));
        break;
      case Kind::string:
        EXPECT_EQ(text.front(), '"');
        EXPECT_EQ(text.back(), '"');
        break;
      default:
        break;
    }
    for (const NodeId child : p.document.children(id)) check(p, child);
  };
  for (int i = 0; i < 500; ++i) {
    const std::string text = blank() + value(4) + blank();
    const Parsed p(text);
    ASSERT_TRUE(p.faults.empty()) << text << "\n" << p.first_fault();
    check(p, p.document.root());
  }
}

}  // namespace
}  // namespace sheave::json
