#pragma once
// What cable/edit.h says of cables, told once more and as topology alone: which links a cable has,
// which of its ends are loose, what can be done to it and what comes of that. It shares no code with
// the library, which must accept and refuse the same.

#include <array>
#include <set>
#include <string>
#include <vector>

#include "cable/edit.h"

namespace sheave::fuzz {

/// Any number of things that an edit can refer to are told by their places in these lists, for ever.
class EditModel {
 public:
  enum class Kind { attachment, rolling, pinhole, spool };
  struct Link {
    Kind kind = Kind::attachment;
    int body = -1;        ///< place among the bodies; -1: the world
    bool fresh = false;   ///< it has been inserted by this edit
    bool lifted = false;  ///< the cable has left it: only steps do that
  };
  struct Cable {
    std::vector<Link> links;
    std::array<bool, 2> loose{};
    bool closed = false;
    bool there = true;
    bool added = false;    ///< by this edit
    bool changed = false;  ///< by this edit: what steps have made of others is as it is
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
  std::vector<char> bodies;  ///< whether each is there
  std::vector<Joint> joints;

  // What an edit can ask for. What cannot be makes it illegal, and changes nothing else.
  void add_body() { bodies.push_back(1); }
  void remove_body(int body);
  void add_joint(int body_a, int body_b);
  void remove_joint(int joint);
  void add_cable(Cable cable);
  void remove_cable(int cable);
  /// Becomes the last cable, if it can be.
  void split(int cable, int span);
  void open(int cable, int span);
  void join(int cable, int next);
  void detach(int cable, CableEnd end);
  void attach(int cable, CableEnd end, int body);
  void pay_out(int cable, int span);
  void insert(int cable, int span, Link link);
  void remove_link(int cable, int link);

  /// At the end of an edit: loose ends run off, and all that is referred to must be there.
  void finish();
  /// Why it cannot be; empty if it can.
  [[nodiscard]] const std::string& fault() const { return fault_; }

 private:
  void fail(const char* why) {
    if (fault_.empty()) fault_ = why;
  }
  /// One that can be changed now; null, and a fault, if it cannot.
  Cable* running(int cable, bool may_be_cut = false);
  [[nodiscard]] static bool has_span(const Cable& cable, int span);
  /// Where the cable can come apart; -1, and a fault, if it cannot there.
  int place_to_part(const Cable& cable, int span);
  void run_off(Cable& cable);
  void check(const Cable& cable);

  std::string fault_;
};

}  // namespace sheave::fuzz
