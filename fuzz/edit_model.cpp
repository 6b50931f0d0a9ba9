#include "fuzz/edit_model.h"

#include <algorithm>

#include "engine/index.h"

namespace sheave::fuzz {

void EditModel::remove_body(int body) {
  if (bodies[at(body)] == 0) return fail("the body is no more");
  bodies[at(body)] = 0;
}

void EditModel::add_joint(int body_a, int body_b) { joints.push_back({body_a, body_b, true}); }

void EditModel::remove_joint(int joint) {
  if (!joints[at(joint)].there) return fail("the joint is no more");
  joints[at(joint)].there = false;
}

void EditModel::add_cable(Cable cable) {
  cable.added = true;
  cables.push_back(std::move(cable));
}

void EditModel::remove_cable(int cable) {
  if (!cables[at(cable)].there) return fail("the cable is no more");
  cables[at(cable)].there = false;
}

EditModel::Cable* EditModel::running(int cable, bool may_be_cut) {
  Cable& own = cables[at(cable)];
  own.changed = true;
  if (own.there && !own.added && (may_be_cut || !own.cut)) return &own;
  fail(!own.there  ? "the cable is no more"
       : own.added ? "the cable is being added"
                   : "the cable is cut");
  return nullptr;
}

bool EditModel::has_span(const Cable& cable, int span) {
  const int count = static_cast<int>(cable.links.size());
  if (span < 0 || span >= count || cable.links[at(span)].lifted) return false;
  // The span ends at the next link that the cable touches.
  return cable.closed || std::any_of(cable.links.begin() + span + 1, cable.links.end(),
                                     [](const Link& link) { return !link.lifted; });
}

int EditModel::place_to_part(const Cable& cable, int span) {
  const int count = static_cast<int>(cable.links.size());
  if (cable.cut) span = cable.cut_span;
  const bool there = span < (cable.closed ? count : count - 1) && has_span(cable, span);
  if (!there) fail("there is no such span");
  if (!there) return -1;
  if (cable.links[at(span)].fresh || cable.links[at((span + 1) % count)].fresh) {
    fail("the link beside the span has just come");
    return -1;
  }
  return span;
}

void EditModel::split(int cable, int span) {
  Cable* whole = running(cable, true);
  if (whole == nullptr) return;
  if (whole->closed) return fail("a belt is opened");
  const int place = place_to_part(*whole, span);
  if (place < 0) return;
  Cable rest;
  rest.changed = true;
  rest.links.assign(whole->links.begin() + place + 1, whole->links.end());
  rest.loose = {true, whole->loose[1]};
  whole->links.resize(at(place) + 1);
  whole->loose[1] = true;
  whole->cut = false;
  cables.push_back(std::move(rest));
}

void EditModel::open(int cable, int span) {
  Cable* belt = running(cable, true);
  if (belt == nullptr) return;
  if (!belt->closed) return fail("an open cable is split");
  const int place = place_to_part(*belt, span);
  if (place < 0) return;
  std::rotate(belt->links.begin(), belt->links.begin() + place + 1, belt->links.end());
  belt->closed = belt->cut = false;
  belt->loose = {true, true};
}

void EditModel::join(int cable, int next) {
  Cable* first = running(cable);
  Cable* second = first == nullptr ? nullptr : running(next);
  if (second == nullptr) return;
  if (!first->loose[1] || !second->loose[0]) return fail("an end is not loose");
  if (first == second) {
    if (first->links.size() < 2) return fail("a belt needs two links");
    first->closed = true;
    first->loose = {};
    return;
  }
  if (first->links.empty() || second->links.empty()) return fail("one is fixed to nothing");
  first->links.insert(first->links.end(), second->links.begin(), second->links.end());
  first->loose[1] = second->loose[1];
  second->there = false;
}

void EditModel::detach(int cable, CableEnd end) {
  Cable* own = running(cable);
  if (own == nullptr) return;
  const bool first = end == CableEnd::first;
  if (own->closed) return fail("a belt has no ends");
  if (own->loose[first ? 0 : 1]) return fail("the end is loose");
  own->links.erase(first ? own->links.begin() : own->links.end() - 1);
  own->loose[first ? 0 : 1] = true;
}

void EditModel::attach(int cable, CableEnd end, int body) {
  Cable* own = running(cable);
  if (own == nullptr) return;
  const bool first = end == CableEnd::first;
  if (!own->loose[first ? 0 : 1]) return fail("the end is attached");
  own->links.insert(first ? own->links.begin() : own->links.end(), Link{Kind::attachment, body});
  own->loose[first ? 0 : 1] = false;
}

void EditModel::pay_out(int cable, int span) {
  const Cable* own = running(cable);
  if (own != nullptr && !has_span(*own, span)) fail("there is no such span");
}

void EditModel::insert(int cable, int span, Link link) {
  Cable* own = running(cable);
  if (own == nullptr) return;
  if (!has_span(*own, span)) return fail("there is no such span");
  link.fresh = true;
  own->links.insert(own->links.begin() + span + 1, link);
}

void EditModel::remove_link(int cable, int link) {
  Cable* own = running(cable);
  if (own == nullptr) return;
  if (link <= 0 || link + 1 >= static_cast<int>(own->links.size())) return fail("no such link");
  own->links.erase(own->links.begin() + link);
}

void EditModel::run_off(Cable& cable) {
  // Removes links up to the first one that holds without tension: an attachment, or the drum at the
  // other end.
  while (cable.loose[0] && !cable.links.empty() && cable.links.front().kind != Kind::attachment &&
         (cable.links.size() > 1 || cable.loose[1])) {
    cable.links.erase(cable.links.begin());
  }
  while (cable.loose[1] && !cable.links.empty() && cable.links.back().kind != Kind::attachment &&
         (cable.links.size() > 1 || cable.loose[0])) {
    cable.links.pop_back();
  }
  if (cable.links.empty()) cable.loose = {true, true};
}

void EditModel::check(const Cable& cable) {
  std::vector<const Link*> touched;
  for (const Link& link : cable.links) {
    if (link.body >= 0 && bodies[at(link.body)] == 0) fail("a link is on a body that is no more");
    if (!link.lifted) touched.push_back(&link);
  }
  if (!cable.pulls() || !cable.changed) return;
  if (touched.size() < 2) return fail("a cable touches too few links");
  const std::size_t spans = cable.closed ? touched.size() : touched.size() - 1;
  for (std::size_t i = 0; i < spans; ++i) {
    const Link& a = *touched[i];
    const Link& b = *touched[(i + 1) % touched.size()];
    const auto is_wheel = [](const Link& link) {
      return link.kind == Kind::rolling || link.kind == Kind::spool;
    };
    const bool points = a.kind == Kind::attachment && b.kind == Kind::attachment;
    if (points && a.body == b.body) fail("a span joins two points of one body");
    if (is_wheel(a) && is_wheel(b) && a.body == b.body) fail("a wheel follows itself");
  }
}

void EditModel::finish() {
  for (Cable& cable : cables) {
    if (!cable.there) continue;
    if (!cable.closed) run_off(cable);
    check(cable);
    cable.added = cable.changed = false;
    for (Link& link : cable.links) link.fresh = false;
  }
  for (const Joint& joint : joints) {
    if (!joint.there) continue;
    for (const int body : {joint.body_a, joint.body_b}) {
      if (body >= 0 && bodies[at(body)] == 0) fail("a joint is on a body that is no more");
    }
  }
}

}  // namespace sheave::fuzz
