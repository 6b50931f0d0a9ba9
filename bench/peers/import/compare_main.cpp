// Tendons of models in Sheave and in MuJoCo at random poses, and the time of a step in both:
//
//   sheave_import_compare POSES MODEL.xml... > table.md
//
// A row has the largest differences of lengths and of moment arms of the tendons that are cables;
// fixed tendons are couplings, whose moment arms are their factors. Moment arms are those about hinges and slides that are the only joints of their
// bodies. Times are of the processor, the least of five runs of 200 steps from the same pose, each
// program with its own defaults and the step of the model.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include <mujoco/mujoco.h>
#include <time.h>

#include <fmt/format.h>

#include "cable/cable_report.h"
#include "scenes/control/scene_supervisor.h"
#include "scenes/import/import.h"
#include "scenes/import/xml.h"
#include "statics/joint_space.h"

namespace {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// The least time of a step in five runs [s].
template <class Begin, class Step>
double time_of_step(const Begin& begin, const Step& step) {
  constexpr int steps = 200;
  double least = 1e300;
  for (int run = 0; run < 5; ++run) {
    begin();
    const double start = processor_time();
    for (int i = 0; i < steps; ++i) step();
    least = std::min(least, (processor_time() - start) / steps);
  }
  return least;
}

/// A <spatial> of the text, with the divisors of its branches.
struct Path {
  int line = 0;
  bool fixed = false;
  std::vector<double> divisors;
};

std::vector<Path> paths_of(const sheave::import::xml::Element& root) {
  std::vector<Path> paths;
  for (const auto& section : root.children) {
    if (section.tag != "tendon") continue;
    for (const auto& tendon : section.children) {
      Path path{tendon.line, tendon.tag == "fixed", {}};
      bool empty = true;
      for (const auto& part : tendon.children) {
        if (part.tag == "pulley") {
          path.divisors.push_back(std::atof(part.value("divisor")->c_str()));
        } else if (path.divisors.empty() && empty) {
          path.divisors.push_back(1.0);
        }
        empty = false;
      }
      paths.push_back(std::move(path));
    }
  }
  return paths;
}

/// Lengths and moment arms of one pose, by the line of the tendon.
struct Measured {
  struct Tendon {
    std::vector<double> lengths;  ///< of its cables [m]
    std::vector<std::map<std::string, double>> arms;
  };
  std::map<int, Tendon> tendons;
};

double length_of(const sheave::CableReport& cable) {
  double length = 0.0;
  for (std::size_t k = 0; k < cable.spans.size(); ++k) {
    if (cable.links[k].touched) length += cable.spans[k].length;
  }
  for (const auto& link : cable.links) length += link.stored_length + link.stored_stretch;
  return length;
}

sheave::Result<sheave::Simulation> simulation_of(const sheave::import::Outcome& made) {
  sheave::SceneResult scene = sheave::load_scene_text(made.json, "made");
  if (!scene) return sheave::Error{"", to_string(scene.errors.front())};
  return sheave::create_simulation(*scene.scene);
}

Measured measure(const sheave::import::Outcome& made) {
  Measured result;
  sheave::Result<sheave::Simulation> simulation = simulation_of(made);
  if (!simulation) return result;
  sheave::Result<sheave::JointSpace> space = sheave::JointSpace::create(*simulation);
  const auto reports = simulation->cable_reports();
  const sheave::CableArms arms = space ? space->cable_arms() : sheave::CableArms{};
  for (const sheave::import::Origin& origin : made.origins) {
    if (!origin.pointer.starts_with("/cables/")) continue;
    const auto cable = static_cast<std::size_t>(std::atoi(origin.pointer.c_str() + 8));
    Measured::Tendon& tendon = result.tendons[origin.line];
    tendon.lengths.push_back(length_of(reports[cable]));
    std::map<std::string, double>& own = tendon.arms.emplace_back();
    for (std::size_t i = 0; space && i < space->coordinates().size(); ++i) {
      const std::string& name = space->coordinates()[i].name;
      own[name.substr(0, name.rfind('.'))] =
          arms.arms(static_cast<Eigen::Index>(cable), static_cast<Eigen::Index>(i));
    }
  }
  return result;
}

class Comparison {
 public:
  Comparison(const std::string& path, const mjModel& model, unsigned seed)
      : path_(path), model_(model), data_(mj_makeData(&model)), random_(seed) {
    std::ifstream file(path);
    text_.assign(std::istreambuf_iterator<char>(file), {});
  }

  /// The rest of a row of the table.
  std::string compare(int poses) {
    const auto tree = sheave::import::xml::parse(text_, path_, {});
    const sheave::import::Outcome plain = sheave::import::import_model(text_, path_);
    if (!plain.errors.empty()) {
      const auto& error = plain.errors.front();
      return fmt::format("refused, line {}: {} | | | | | |", error.line, error.message);
    }
    const std::vector<Path> paths = paths_of(*tree.root);
    for (int i = 0; i < poses; ++i) look_at(draw(), paths);
    const auto number = [&](double value) {
      return compared_ == 0 ? std::string() : fmt::format("{:.1e}", value);
    };
    long couplings = 0;
    for (const Path& path : paths) {
      couplings += std::count_if(plain.origins.begin(), plain.origins.end(), [&](const auto& one) {
        return path.fixed && one.line == path.line && one.pointer.starts_with("/joints/");
      });
    }
    const std::string jumps = longer_ > 0 ? fmt::format("; {} longer there", longer_) : "";
    return fmt::format("{} and {} of {} | {} | {}{} | {} | {} | {:.1f} | {:.1f} |", taken_.size(),
                       couplings, paths.size(), compared_, number(length_), jumps, compared_arms_,
                       number(arm_), 1e6 * own_time(plain), 1e6 * their_time());
  }

 private:
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967295.0;
  }

  /// The text with a keyframe of a random pose, which MuJoCo then has.
  std::string draw() {
    mj_resetData(&model_, data_.get());
    for (int j = 0; j < model_.njnt; ++j) {
      mjtNum* const q = data_->qpos + model_.jnt_qposadr[j];
      const int type = model_.jnt_type[j];
      if (type == mjJNT_FREE) {
        for (int i = 0; i < 3; ++i) q[i] += uniform(-0.05, 0.05);
      } else if (type == mjJNT_BALL) {
        for (int i = 0; i < 4; ++i) q[i] += uniform(-0.3, 0.3);
        mju_normalize4(q);
      } else {
        const bool limited = model_.jnt_limited[j] != 0;
        const double wide = type == mjJNT_SLIDE ? 0.02 : 0.6;
        q[0] = limited ? uniform(model_.jnt_range[2 * j], model_.jnt_range[2 * j + 1])
                       : q[0] + uniform(-wide, wide);
      }
    }
    mj_forward(&model_, data_.get());
    std::string key = "<keyframe><key name=\"compare\" qpos=\"";
    for (int i = 0; i < model_.nq; ++i) key += fmt::format("{:.17g} ", data_->qpos[i]);
    std::string text = text_;
    return text.insert(text.rfind("</mujoco>"), key + "\"/></keyframe>");
  }

  [[nodiscard]] double moment(int tendon, int velocity) const {
    if (mj_isSparse(&model_) == 0) return data_->ten_J[tendon * model_.nv + velocity];
    const int at = data_->ten_J_rowadr[tendon];
    for (int k = 0; k < data_->ten_J_rownnz[tendon]; ++k) {
      if (data_->ten_J_colind[at + k] == velocity) return data_->ten_J[at + k];
    }
    return 0.0;
  }

  void look_at(const std::string& text, const std::vector<Path>& paths) {
    sheave::import::Options options;
    options.keyframe = "compare";
    const Measured own = measure(sheave::import::import_model(text, path_, options));
    for (std::size_t t = 0; t < paths.size(); ++t) {
      const auto found = own.tendons.find(paths[t].line);
      if (found == own.tendons.end() || paths[t].fixed) continue;
      const Measured::Tendon& tendon = found->second;
      if (tendon.lengths.size() != paths[t].divisors.size()) continue;
      taken_[paths[t].line] = true;
      ++compared_;
      const auto sum = [&](const auto& value) {
        double total = 0.0;
        for (std::size_t k = 0; k < tendon.lengths.size(); ++k) {
          total += value(k) / paths[t].divisors[k];
        }
        return total;
      };
      const int number = static_cast<int>(t);
      const double longer =
          data_->ten_length[number] - sum([&](std::size_t k) { return tendon.lengths[k]; });
      // Of two ways that pass the inside of a geom the longer one is not the shortest.
      if (longer > 1e-8) {
        ++longer_;
        continue;
      }
      length_ = std::max(length_, std::abs(longer));
      for (int j = 0; j < model_.njnt; ++j) {
        const char* const name = mj_id2name(&model_, mjOBJ_JOINT, j);
        const bool one = model_.body_jntnum[model_.jnt_bodyid[j]] == 1;
        if (name == nullptr || !one || !tendon.arms.front().contains(name)) continue;
        ++compared_arms_;
        const double arm = sum([&](std::size_t k) { return tendon.arms[k].at(name); });
        arm_ = std::max(arm_, std::abs(arm - moment(number, model_.jnt_dofadr[j])));
      }
    }
  }

  static double own_time(const sheave::import::Outcome& made) {
    sheave::Result<sheave::Simulation> simulation = simulation_of(made);
    if (!simulation) return std::nan("");
    const sheave::State start = simulation->world.state();
    return time_of_step([&] { static_cast<void>(simulation->world.restore(start)); },
                        [&] { static_cast<void>(simulation->step()); });
  }
  double their_time() {
    return time_of_step([&] { mj_resetData(&model_, data_.get()); },
                        [&] { mj_step(&model_, data_.get()); });
  }

  std::string path_;
  std::string text_;
  const mjModel& model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::mt19937 random_;
  std::map<int, bool> taken_;
  long compared_ = 0;
  long compared_arms_ = 0;
  long longer_ = 0;
  double length_ = 0.0;
  double arm_ = 0.0;
};

}  // namespace

int main(int count, char** words) {
  if (count < 3 || std::atoi(words[1]) < 1) {
    std::fputs("usage: sheave_import_compare POSES MODEL.xml...\n", stderr);
    return 2;
  }
  mju_user_warning = [](const char* text) { std::fprintf(stderr, "%s\n", text); };
  std::puts(
      "| model | cables and couplings | lengths | largest difference [m] | moment arms | largest "
      "difference [m or m/rad] | a step here [us] | in MuJoCo [us] |\n"
      "|---|---|---|---|---|---|---|---|");
  for (int i = 2; i < count; ++i) {
    std::array<char, 1000> error{};
    const std::unique_ptr<mjModel, ModelDeleter> model(
        mj_loadXML(words[i], nullptr, error.data(), static_cast<int>(error.size())));
    const std::string name = std::filesystem::path(words[i]).filename().string();
    if (!model) {
      std::printf("| %s | MuJoCo %s cannot read it | | | | | | |\n", name.c_str(),
                  mj_versionString());
      continue;
    }
    const std::string row = Comparison(words[i], *model, 1).compare(std::atoi(words[1]));
    std::printf("| %s | %s\n", name.c_str(), row.c_str());
    std::fflush(stdout);
  }
  return 0;
}
