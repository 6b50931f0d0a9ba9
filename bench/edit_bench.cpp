// How long an edit of one cable takes in a world of 500 spans.

#include "bench/edit_bench.h"

#include <memory>

#include <benchmark/benchmark.h>

#include "cable/edit.h"
#include "cable/links/attachment.h"
#include "cable/links/rolling.h"
#include "cable/live_world.h"
#include "engine/shapes/cylinder.h"

namespace sheave::bench {
namespace {

constexpr double radius = 0.2;  // [m]

std::shared_ptr<AttachmentLink> attached(BodyId body) {
  auto link = std::make_shared<AttachmentLink>();
  link->body = body;
  return link;
}

/// Adds a weight, and a cable from it over an odd number of wheels, every other one from below, to
/// a second weight.
void add_train(int number, int wheels, Model& model, std::vector<CableDef>& cables) {
  const std::string suffix = " " + std::to_string(number);
  const auto z = static_cast<double>(number);
  const auto weight = [&](const std::string& name, double x) {
    BodyDef body;
    body.name = name + suffix;
    body.mobility = Mobility::slider;
    body.axis = Vector3::UnitY();
    body.mass = 1.0;
    body.position = {x, -10.0, z};
    return model.add(body);
  };
  CableDef rope;
  rope.name = "rope" + suffix;
  rope.links.push_back(attached(weight("left", -radius)));
  auto shape = std::make_shared<Cylinder>();
  shape->radius = radius;
  for (int i = 0; i < wheels; ++i) {
    const bool under = i % 2 == 1;
    BodyDef wheel;
    wheel.name = "wheel " + std::to_string(i) + suffix;
    wheel.mobility = Mobility::rotor;
    wheel.position = {3.0 * radius * i, under ? -1.5 * radius : 0.0, z};
    wheel.mass = 1.0;
    wheel.shapes = {{shape}};
    auto link = std::make_shared<RollingLink>();
    link->body = model.add(wheel);
    link->winding = under ? Winding::counter_clockwise : Winding::clockwise;
    rope.links.push_back(link);
  }
  const double end = 3.0 * radius * (wheels - 1) + radius;
  rope.links.push_back(attached(weight("right", end)));
  cables.push_back(rope);
}

/// `change` is done again and again to a world of `count` cables of `spans` spans each, and to the
/// middle one of them.
template <class Change>
void time_edit(const char* name, int count, int spans, Change change) {
  benchmark::RegisterBenchmark(name, [=](benchmark::State& state) {
    Model model;
    std::vector<CableDef> cables;
    for (int i = 0; i < count; ++i) add_train(i, spans - 1, model, cables);
    Result<LiveWorld> world = LiveWorld::create(model, cables);
    if (!world) return state.SkipWithError(world.errors().front().message.c_str());
    if (!world->step().ok()) return state.SkipWithError("the first step diverged");
    const CableHandle cable = world->cables()[static_cast<std::size_t>(count / 2)];
    for (auto _ : state) {
      const auto done = world->edit([&](Edit& edit) { change(edit, cable); });
      if (!done) return state.SkipWithError(done.errors().front().message.c_str());
      benchmark::DoNotOptimize(done->energy);
    }
  });
}

void pay_out(Edit& edit, CableHandle cable) { edit.pay_out(cable, 1, 1e-6); }

void split_and_join(Edit& edit, CableHandle cable) {
  edit.join(cable, edit.split(cable, 1, 0.5, "other half"));
}

void add_and_remove_body(Edit& edit, CableHandle /*cable*/) {
  BodyDef body;
  body.name = "guest";
  body.mass = 1.0;
  edit.remove(edit.add(body));
}

}  // namespace

void register_edit_benchmarks() {
  time_edit("edit_pay_out/one_cable_of_500_spans", 1, 500, pay_out);
  time_edit("edit_pay_out/one_of_125_cables_of_4_spans", 125, 4, pay_out);
  time_edit("edit_split_and_join/one_of_125_cables_of_4_spans", 125, 4, split_and_join);
  time_edit("edit_add_and_remove_body/125_cables_of_4_spans", 125, 4, add_and_remove_body);
}

}  // namespace sheave::bench
