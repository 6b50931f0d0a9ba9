// A crane operator's loop: levers set the speeds of two winches, and the load's rope tells when to
// stop.

#include <algorithm>
#include <cstdio>

#include <sheave/sheave.h>

namespace {

int report(const sheave::Errors& errors) {
  for (const sheave::Error& error : errors) std::puts(error.message.c_str());
  return 1;
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return std::puts("usage: crane scenes/machines/crane.json"), 2;
  auto crane = sheave::load(arguments[1]);    // or sheave::LiveWorld::create(model, cables)
  if (!crane) return report(crane.errors());  // errors are values: nothing exits or prints
  sheave::Errors faults;                      // a name that is not there leaves its message here
  const auto hoist = crane->body("hoist winch").value(faults);
  const auto luff = crane->body("luff winch").value(faults);
  const auto hook = crane->body("hook").value(faults);
  const auto rope = crane->cable("hoist cable").value(faults);
  double hoist_lever = 0.0, luff_lever = 0.0, most = 0.0;
  while (faults.empty() && crane->time() < 20.0) {
    // The operator hoists for 8 s, luffs for the rest, and stops hoisting under too much tension.
    const double tension = crane->tension(rope, 0).value(faults);
    const bool hoisting = crane->time() < 8.0;
    // Levers move gently, so that the load feels no blow.
    hoist_lever += 0.02 * ((hoisting && tension < 30e3 ? 2.0 : 0.0) - hoist_lever);
    luff_lever += 0.02 * ((hoisting ? 0.0 : 1.0) - luff_lever);
    for (const auto& errors :
         {crane->set_speed(hoist, hoist_lever), crane->set_speed(luff, luff_lever)})
      faults.insert(faults.end(), errors.begin(), errors.end());
    if (const auto step = crane->step(); !step.ok())
      return std::puts("the crane's motion ended"), 1;
    most = std::max(most, tension);
  }
  const sheave::Vector3 at = crane->pose(hook).value(faults).position;
  if (!faults.empty()) return report(faults);
  std::printf("the hook is at (%.2f, %.2f) m; its rope had %.1f kN at most\n", at.x(), at.y(),
              1e-3 * most);
  return at.y() > 4.0 && most < 30e3 ? 0 : 1;
}
