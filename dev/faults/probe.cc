// Runs scenes and prints what the certificate finds, for bench/tables/mutation-table (which compiles it; no part of the command).
//
//   probe [--every N] [--time T] SCENE SOLVER INTEGRATOR ...
//
// Per scene one line "scene solver integrator status worst kind name", tab-separated, then one per kind: "\tkind relative
// value scale unit time name". `own` leaves the scene's setting. Each kind has its worst over all steps that were checked.

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "cable/certificate.h"
#include "cable/simulation.h"
#include "scenes/scene.h"

using namespace sheave;

namespace {

struct Settings {
  int every = 1;
  double longest = 1e300;
};

void run(const std::string& path, const std::string& solver, const std::string& integrator,
         const Settings& settings) {
  SceneResult loaded = load_scene(path);
  const auto head = [&](const char* status, double worst, const std::string& rest) {
    std::printf("%s\t%s\t%s\t%s\t%.3g\t%s\n", path.c_str(), solver.c_str(), integrator.c_str(),
                status, worst, rest.c_str());
  };
  if (!loaded.scene) return head("unreadable", 0.0, "\t");
  Scene& scene = *loaded.scene;
  StepSettings& step = scene.model.step;
  if (solver == "direct") step.solver = SolverKind::direct;
  if (solver == "gauss-seidel") step.solver = SolverKind::gauss_seidel;
  if (integrator == "rattle") step.integrator = IntegratorKind::rattle;
  if (integrator == "xpbd") step.integrator = IntegratorKind::xpbd;
  auto simulation = Simulation::create(scene.model, scene.cables);
  if (!simulation) return head("invalid", 0.0, "\t");
  Certificate all;
  bool ok = true;
  const double end = std::min(scene.duration, settings.longest);
  for (long n = 0; ok && simulation->world.state().time < end - 1e-9; ++n) {
    ok = simulation->world.step().ok();
    if (!ok || n % settings.every != 0) continue;
    if (const auto one = simulation->certificate()) all.merge(*one);
  }
  const CertificateItem* worst = all.worst();
  const std::string kind =
      worst == nullptr
          ? "\t"
          : std::string(certificate_kind_names[static_cast<std::size_t>(worst->kind)]) + "\t" +
                worst->name;
  head(!ok ? "diverged" : all.clean() ? "clean" : "doubtful",
       worst == nullptr ? 0.0 : worst->relative, kind);
  for (const CertificateItem& item : all.items) {
    std::printf("\t%s\t%.3g\t%.6g\t%.6g\t%s\t%.6g\t%s\n",
                std::string(certificate_kind_names[static_cast<std::size_t>(item.kind)]).c_str(),
                item.relative, item.value, item.scale, std::string(item.unit).c_str(), item.time,
                item.name.c_str());
  }
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  Settings settings;
  int i = 1;
  for (; i + 1 < argc && argv[i][0] == '-'; i += 2) {
    if (std::string(argv[i]) == "--every") settings.every = std::atoi(argv[i + 1]);
    if (std::string(argv[i]) == "--time") settings.longest = std::atof(argv[i + 1]);
  }
  for (; i + 2 < argc; i += 3) run(argv[i], argv[i + 1], argv[i + 2], settings);
  return 0;
}
