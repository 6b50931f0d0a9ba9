// The README's program: it winds a winch in as long as the rope can bear it.

#include <cstdio>

#include <sheave/sheave.h>

int report(const sheave::Errors& errors) {
  for (const sheave::Error& error : errors) std::puts(error.message.c_str());
  return 1;
}

int main() {
  auto crane = sheave::load("scenes/machines/crane.json");  // or LiveWorld::create(model, cables)
  if (!crane) return report(crane.errors());                // errors are values
  sheave::Errors faults;  // a name that is not there leaves its message here
  const auto winch = crane->body("hoist winch").value(faults);
  const auto rope = crane->cable("hoist cable").value(faults);
  while (faults.empty() && crane->time() < 5.0) {
    const double tension = crane->tension(rope, 0).value(faults);
    if (faults.empty()) faults = crane->set_speed(winch, tension > 30e3 ? 0.0 : 0.5);
    if (!crane->step().ok()) return std::puts("the crane's motion diverged"), 1;
  }
  if (!faults.empty()) return report(faults);
  return std::printf("%.1f kN\n", 1e-3 * crane->tension(rope, 0).value()), 0;
}
