#include <fmt/format.h>

#include "command/explain/explain.h"
#include "statics/joint_space.h"

namespace sheave::command {
namespace {

std::string joints_sentence(const Simulation& simulation, std::size_t freedoms,
                            const std::vector<MachineCoordinate>& coordinates) {
  std::vector<std::string> names;
  for (const MachineCoordinate& coordinate : coordinates) names.push_back(coordinate.name);
  const std::string all = fmt::format("The bodies that can move have {}",
                                      counted(freedoms, "degree of freedom", "degrees of freedom"));
  const std::string left = names.empty() ? std::string() : fmt::format(": {}", joined_names(names));
  if (simulation.world.model().joints.empty()) return all + left + ".";
  if (names.empty()) return all + ", and the joints leave none of them.";
  return fmt::format("{}, and the joints leave {} of them{}.", all, names.size(), left);
}

}  // namespace

Sentences explain_freedom(Simulation& simulation) {
  const std::size_t freedoms = freedom_names(simulation).size();
  if (freedoms == 0) return {"No body can move by itself: drives and tables prescribe all motion."};
  if (freedoms > static_cast<std::size_t>(JointSpace::most_freedoms)) {
    return {
        fmt::format("The bodies have {} degrees of freedom; beyond {} the joints and cables "
                    "are not analysed.",
                    freedoms, JointSpace::most_freedoms)};
  }
  const Result<JointSpace> space = JointSpace::create(simulation);
  if (!space) return {space.errors().front().message + "."};
  const std::size_t left = space->coordinates().size();
  Sentences sentences{joints_sentence(simulation, freedoms, space->coordinates())};
  const Modes modes = find_modes(simulation);
  const auto motions = static_cast<std::size_t>(modes.motions.cols());
  if (motions < left) {
    sentences.push_back(fmt::format(
        "Rigid cables, drives to speeds and positions, stops, contacts and dry friction that carry "
        "load here hold {} more; {} left.",
        left - motions,
        motions == 0   ? std::string("no motion is")
        : motions == 1 ? std::string("one motion is")
                       : fmt::format("{} motions are", motions)));
  }
  if (modes.redundant > 0) {
    sentences.push_back(fmt::format(
        "{} redundant: the machine is held there more than once, so the forces of "
        "these constraints are not unique.",
        modes.redundant == 1 ? std::string("One rigid constraint is")
                             : fmt::format("{} rigid constraints are", modes.redundant)));
  }
  return sentences;
}

}  // namespace sheave::command
