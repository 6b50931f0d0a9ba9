// A crane operator's loop: levers set the speeds of two winches, and the load's rope tells when to
// stop.

#include <algorithm>
#include <cstdio>

#include "sheave/sheave.h"

int main(int count, char** arguments) {
  using namespace sheave;
  if (count != 2) return std::puts("usage: crane scenes/machines/crane.json"), 2;
  auto crane = load(arguments[1]);
  if (!crane) {
    for (const Error& error : crane.errors()) std::puts(error.message.c_str());
    return 1;
  }
  const auto hoist = *crane->body("hoist winch"), luff = *crane->body("luff winch");
  const auto hook = *crane->body("hook");
  const auto rope = *crane->cable("hoist cable");
  double lever_hoist = 0.0, lever_luff = 0.0;
  double most = 0.0;
  while (crane->time() < 20.0) {
    // The operator: hoist for 8 s, luff for the rest, and let go of a lever when the rope is too
    // tight.
    const double wanted_hoist = crane->time() < 8.0 ? 2.0 : 0.0;
    const double wanted_luff = crane->time() < 8.0 ? 0.0 : 1.0;
    const double tension = *crane->tension(rope, 0);
    const bool overload = tension > 30e3;
    // Levers move gently; drives get to a new speed within the step, so that the load feels no
    // blows.
    lever_hoist += 0.02 * ((overload ? 0.0 : wanted_hoist) - lever_hoist);
    lever_luff += 0.02 * (wanted_luff - lever_luff);
    Errors errors = crane->set_speed(hoist, lever_hoist);
    if (errors.empty()) errors = crane->set_speed(luff, lever_luff);
    if (!errors.empty()) return std::puts(errors[0].message.c_str()), 1;
    if (const auto report = crane->step(); !report.ok()) return 1;
    most = std::max(most, tension);
  }
  const Vector3 at = crane->pose(hook)->position;
  std::printf("the hook is at (%.2f, %.2f) m; its rope had %.1f kN at most\n", at.x(), at.y(),
              1e-3 * most);
  return at.y() > 4.0 && most < 30e3 ? 0 : 1;
}
