#include "command/modes/report.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "command/failure.h"
#include "command/output/file.h"
#include "command/terminal.h"
#include "command/text/table.h"
#include "scenes/quantity_list.h"

namespace sheave::command {
namespace {

using ModesJson = nlohmann::ordered_json;

/// An unbalanced load above this part of the largest load means that the state is no equilibrium.
constexpr double rests = 1e-6;

std::string notes(const ModesFound& found) {
  std::string text;
  const Modes& modes = found.modes;
  if (modes.imbalance > rests) {
    text += fmt::format(
        "not at rest: {:.1e} of the forces are unbalanced, so the modes are those of this pose "
        "held as it is\n",
        modes.imbalance);
  }
  if (found.rest && found.rest->stability == Stability::unstable) {
    text += "unstable: modes with a negative square of the frequency grow without bound\n";
  }
  if (modes.redundant > 0) {
    text += fmt::format("{} redundant rigid constraints: their forces are not unique\n",
                        modes.redundant);
  }
  if (modes.friction_slides) {
    text += "cable slides over links with friction: small motions there are no vibration\n";
  }
  return text;
}

std::string frequency_text(const Mode& mode) {
  if (mode.frequency > 0.0) return short_number(mode.frequency);
  return mode.eigenvalue < 0.0 ? "runs away" : "0";
}

ModesJson matrix_json(const Eigen::MatrixXd& matrix) {
  ModesJson rows = ModesJson::array();
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    ModesJson row = ModesJson::array();
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) row.push_back(matrix(i, k));
    rows.push_back(std::move(row));
  }
  return rows;
}

/// NumPy's format, version 1.0: a plain two-dimensional array of float64 in C order.
void write_matrix(const std::string& path, const Eigen::MatrixXd& matrix) {
  std::string header =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({}, {}), }}", matrix.rows(),
                  matrix.cols());
  constexpr std::size_t before = 10;
  constexpr std::size_t alignment = 64;
  header += std::string((alignment - (before + header.size() + 1) % alignment) % alignment, ' ');
  header += '\n';
  std::string text = "\x93NUMPY";
  text += std::string("\x01\x00", 2);
  text += static_cast<char>(header.size() & 0xffU);
  text += static_cast<char>(header.size() >> 8U & 0xffU);
  text += header;
  for (Eigen::Index i = 0; i < matrix.rows(); ++i) {
    for (Eigen::Index k = 0; k < matrix.cols(); ++k) {
      std::uint64_t bits = 0;
      const double value = matrix(i, k);
      std::memcpy(&bits, &value, sizeof bits);
      for (unsigned byte = 0; byte < 8; ++byte) {
        text += static_cast<char>(bits >> (8U * byte) & 0xffU);
      }
    }
  }
  OutputFile file(path);
  file.write(text);
  file.commit();
}

}  // namespace

void take_outputs(Simulation& simulation, const std::vector<std::string>& names,
                  ModesFound& found) {
  found.outputs = names;
  const Eigen::Index states = found.modes.state_matrix.cols();
  found.output_matrix = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(names.size()), states);
  if (names.empty()) return;
  QuantityList outputs(QuantityIndex::of(simulation, names));
  for (const std::string& name : names) {
    const Errors faults = outputs.add(name);
    if (!faults.empty()) throw Failure(ExitCode::usage, "--output: " + to_text(faults));
    if (!outputs.follows_from_state(outputs.size() - 1)) {
      throw Failure(ExitCode::usage,
                    "--output " + name + ": this quantity does not follow from a state alone");
    }
  }
  const State here = simulation.world.state();
  const Modes& modes = found.modes;
  const Eigen::Index k = modes.motions.cols();
  Eigen::VectorXd x = Eigen::VectorXd::Zero(states);
  std::vector<double> values(names.size());
  const auto sample = [&](double step, Eigen::Index column) {
    x[column] = step;
    const State there = perturbed_state(simulation, modes, x);
    x[column] = 0.0;
    if (const Errors errors = simulation.world.restore(there); !errors.empty()) {
      throw Failure(ExitCode::internal, to_text(errors));
    }
    outputs.sample(simulation, values);
    if (!simulation.world.restore(here).empty()) throw Failure(ExitCode::internal, "restore");
    return Eigen::VectorXd(
        Eigen::Map<const Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size())));
  };
  constexpr double step = 1e-4;
  for (Eigen::Index i = 0; i < states; ++i) {
    // The step moves the largest component by 1e-4 m or rad.
    const double size = i < 2 * k ? modes.motions.col(i % k).cwiseAbs().maxCoeff() : 1.0;
    const double by = size > 0.0 ? step / size : step;
    found.output_matrix.col(i) = (sample(by, i) - sample(-by, i)) / (2.0 * by);
  }
}

void write_matrices(const std::string& name, const ModesFound& found) {
  const Modes& modes = found.modes;
  write_matrix(name + ".M.npy", modes.mass);
  write_matrix(name + ".D.npy", modes.damping);
  write_matrix(name + ".K.npy", modes.stiffness);
  write_matrix(name + ".Z.npy", modes.motions);
  write_matrix(name + ".A.npy", modes.state_matrix);
  write_matrix(name + ".B.npy", modes.input_matrix);
  write_matrix(name + ".C.npy", found.output_matrix);
}

std::string modes_text(const ModesFound& found, std::size_t count) {
  const Modes& modes = found.modes;
  std::string text =
      fmt::format("{}: {} modes of {} degrees of freedom\n{}\n", printable_line(found.scene),
                  modes.modes.size(), found.freedoms.size(), notes(found));
  if (modes.modes.empty()) return text + "  no body can move\n";
  TextTable table(
      {"mode", "most of its energy", "moves most", "frequency [Hz]", "period [s]", "damping ratio"},
      3);
  for (std::size_t i = 0; i < std::min(count, modes.modes.size()); ++i) {
    const Mode& mode = modes.modes[i];
    const std::string body =
        mode.body < 0
            ? ""
            : fmt::format("{} ({:.0f} %)", found.bodies[static_cast<std::size_t>(mode.body)],
                          100.0 * mode.body_share);
    const bool vibrates = mode.frequency > 0.0;
    table.add({fmt::format("{}", i + 1), body, found.motions[i], frequency_text(mode),
               vibrates ? short_number(1.0 / mode.frequency) : "",
               vibrates ? short_number(mode.damping_ratio) : ""});
  }
  text += table.text();
  if (count < modes.modes.size()) {
    text += fmt::format("  ... and {} more (--count)\n", modes.modes.size() - count);
  }
  return text;
}

std::string modes_table(const std::vector<ModesFound>& cases, std::size_t count) {
  std::size_t shown = 0;
  for (const ModesFound& found : cases) shown = std::max(shown, found.modes.modes.size());
  const std::size_t most = shown;
  shown = std::min(shown, count);
  std::vector<std::string> head{"case", "stability"};
  for (std::size_t k = 0; k < shown; ++k) head.push_back(fmt::format("mode {} [Hz]", k + 1));
  TextTable table(std::move(head), 2);
  std::string text;
  for (const ModesFound& found : cases) {
    std::vector<std::string> cells{found.name,
                                   !found.rest                                    ? "as it is"
                                   : found.rest->stability == Stability::unstable ? "unstable"
                                   : found.rest->stability == Stability::stable   ? "stable"
                                                                                  : "neutral"};
    for (std::size_t k = 0; k < shown; ++k) {
      const bool has = k < found.modes.modes.size();
      cells.push_back(has ? frequency_text(found.modes.modes[k]) : "");
    }
    table.add(std::move(cells));
    const std::string noted = notes(found);
    for (std::size_t at = 0; at < noted.size();) {
      const std::size_t end = noted.find('\n', at);
      text += fmt::format("{}: {}\n", printable_line(found.name), noted.substr(at, end - at));
      at = end + 1;
    }
  }
  text += (text.empty() ? "" : "\n") + table.text();
  if (shown < most) text += fmt::format("  ... and up to {} more modes (--count)\n", most - shown);
  return text;
}

namespace {

ModesJson modes_object(const std::string& path, const ModesFound& found) {
  const Modes& modes = found.modes;
  ModesJson list = ModesJson::array();
  for (std::size_t k = 0; k < modes.modes.size(); ++k) {
    const Mode& mode = modes.modes[k];
    ModesJson shape = ModesJson::object();
    for (std::size_t i = 0; i < found.freedoms.size(); ++i) {
      shape[found.freedoms[i]] = mode.shape[static_cast<Eigen::Index>(i)];
    }
    list.push_back(
        {{"eigenvalue", mode.eigenvalue},
         {"frequency", mode.frequency},
         {"damping_ratio", mode.damping_ratio},
         {"body", mode.body < 0 ? ModesJson()
                                : ModesJson(found.bodies[static_cast<std::size_t>(mode.body)])},
         {"body_share", mode.body_share},
         {"moves_most", found.motions[k]},
         {"shape", std::move(shape)}});
  }
  ModesJson poles = ModesJson::array();
  for (const auto& pole : modes.poles) {
    poles.push_back(ModesJson::array({pole.real(), pole.imag()}));
  }
  ModesJson object{{"format", "sheave-modes/1"},
                   {"scene", path},
                   {"at_rest", modes.imbalance <= rests},
                   {"imbalance", modes.imbalance},
                   {"difference_error", modes.error},
                   {"redundant", modes.redundant},
                   {"friction_slides", modes.friction_slides},
                   {"modes", std::move(list)},
                   {"poles", std::move(poles)},
                   {"inputs", found.inputs},
                   {"outputs", found.outputs},
                   {"A", matrix_json(modes.state_matrix)},
                   {"B", matrix_json(modes.input_matrix)},
                   {"C", matrix_json(found.output_matrix)}};
  if (!found.name.empty()) object["name"] = found.name;
  return object;
}

std::string dumped(const ModesJson& object) {
  return object.dump(-1, ' ', false, ModesJson::error_handler_t::replace) + "\n";
}

}  // namespace

std::string modes_json(const std::string& path, const ModesFound& found) {
  return dumped(modes_object(path, found));
}

std::string modes_cases_json(const std::string& path, const std::vector<ModesFound>& cases) {
  ModesJson list = ModesJson::array();
  for (const ModesFound& found : cases) list.push_back(modes_object(path, found));
  return dumped({{"format", "sheave-modes/1"}, {"scene", path}, {"cases", std::move(list)}});
}

}  // namespace sheave::command
