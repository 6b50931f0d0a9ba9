#pragma once
// A second, purely topological implementation of the rules in cable/edit.h: the links of a cable,
// its loose ends, the legal edits and their results. The model shares no code with the library, and
// both must accept and refuse the same edits.

#include <array>
#include <set>
#include <string>
#include <vector>

#include "cable/edit.h"

namespace sheave::fuzz {

/// Entities are identified by their indices in these lists. Indices are never reused.
class EditModel {
 public:
  enum class Kind { attachment, rolling, pinhole, spool };
  struct Link {
    Kind kind = Kind::attachment;
    int body = -1;        ///< index of the body; -1: the world
    bool fresh = false;   ///< inserted by this edit
    bool lifted = false;  ///< the cable has left it; happens only in steps
  };
  struct Cable {
    std::vector<Link> links;
    std::array<bool, 2> loose{};
    bool closed = false;
    bool there = true;
    bool added = false;    ///< added by this edit
    bool changed = false;  ///< changed by this edit; unchanged cables keep the result of the steps
    bool cut = false;
    int cut_span = 0;
    [[nodiscard]] bool pulls() const { return there && links.size() >= 2; }
  };
  struct Joint {
    int body_a = -1;
    int body_b = -1;
    bool there = true;
  };

  std::vector<Cable> cables;
  std::vector<char> bodies;  ///< whether each body exists
  std::vector<Joint> joints;

  // The operations of an edit. An impossible operation makes the edit illegal and changes nothing.
  void add_body() { bodies.push_back(1); }
  void remove_body(int body);
  void add_joint(int body_a, int body_b);
  void remove_joint(int joint);
  void add_cable(Cable cable);
  void remove_cable(int cable);
  /// The second part becomes the last cable, if the split is possible.
  void split(int cable, int span);
  void open(int cable, int span);
  void join(int cable, int next);
  void detach(int cable, CableEnd end);
  void attach(int cable, CableEnd end, int body);
  void pay_out(int cable, int span);
  void insert(int cable, int span, Link link);
  void remove_link(int cable, int link);

  /// Ends the edit: cable runs off at loose ends, and all referenced entities must exist.
  void finish();
  /// Why the edit is illegal; empty if it is legal.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  void fail(const char* why) {
    if (fault_.empty()) fault_ = why;
  }
  /// A cable that can be changed now; otherwise null and a fault.
  Cable* running(int cable, bool may_be_cut = false);
  [[nodiscard]] static bool has_span(const Cable& cable, int span);
  /// The link index at which the cable can be divided; otherwise -1 and a fault.
  int place_to_part(const Cable& cable, int span);
  void run_off(Cable& cable);
  void check(const Cable& cable);

  std::string fault_;
};

}  // namespace sheave::fuzz
