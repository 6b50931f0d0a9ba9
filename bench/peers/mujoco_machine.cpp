#include "bench/peers/mujoco_machine.h"

#include <array>
#include <cmath>
#include <cstring>
#include <utility>

#include <mujoco/mujoco.h>

#include <fmt/format.h>

namespace sheave::peers {
namespace {

struct ModelDeleter {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
};
struct DataDeleter {
  void operator()(mjData* data) const { mj_deleteData(data); }
};

void read_coordinates(const mjData& data, const std::vector<Coordinate>& coordinates,
                      std::vector<double>& positions, std::vector<double>& rates) {
  positions.clear();
  rates.clear();
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    const double r = coordinates[i].radius;
    const double factor = r > 0.0 ? r : 1.0;
    positions.push_back(factor * data.qpos[i]);
    rates.push_back(factor * data.qvel[i]);
  }
}

/// It reports by itself that a state means nothing, and then starts from the beginning.
bool means_something(const mjData& data) {
  return data.warning[mjWARN_BADQPOS].number == 0 && data.warning[mjWARN_BADQVEL].number == 0 &&
         data.warning[mjWARN_BADQACC].number == 0;
}

class MujocoMachine final : public Machine {
 public:
  MujocoMachine(std::unique_ptr<mjModel, ModelDeleter> model,
                std::unique_ptr<mjData, DataDeleter> data, std::vector<Coordinate> coordinates)
      : model_(std::move(model)), data_(std::move(data)), coordinates_(std::move(coordinates)) {}

  void restart() override { mj_resetData(model_.get(), data_.get()); }
  bool step() override {
    mj_step(model_.get(), data_.get());
    return means_something(*data_);
  }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    read_coordinates(*data_, coordinates_, positions, rates);
  }

 private:
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::unique_ptr<mjData, DataDeleter> data_;
  std::vector<Coordinate> coordinates_;
};

class ManyMujocoWorlds final : public MujocoWorlds {
 public:
  ManyMujocoWorlds(std::unique_ptr<mjModel, ModelDeleter> model,
                   std::vector<std::unique_ptr<mjData, DataDeleter>> worlds,
                   std::vector<Coordinate> coordinates)
      : model_(std::move(model)),
        worlds_(std::move(worlds)),
        coordinates_(std::move(coordinates)) {}

  [[nodiscard]] std::size_t size() const override { return worlds_.size(); }
  void restart(std::size_t world) override { mj_resetData(model_.get(), worlds_[world].get()); }
  bool step(std::size_t world, int steps) override {
    mjData* const data = worlds_[world].get();
    for (int i = 0; i < steps; ++i) mj_step(model_.get(), data);
    return means_something(*data);
  }
  void read(std::size_t world, std::vector<double>& positions,
            std::vector<double>& rates) const override {
    read_coordinates(*worlds_[world], coordinates_, positions, rates);
  }

 private:
  std::unique_ptr<mjModel, ModelDeleter> model_;
  std::vector<std::unique_ptr<mjData, DataDeleter>> worlds_;
  std::vector<Coordinate> coordinates_;
};

/// A file in memory, because the library reads nothing else.
class VirtualFile {
 public:
  VirtualFile(const char* name, const std::string& text) : files_(std::make_unique<mjVFS>()) {
    mj_defaultVFS(files_.get());
    made_ = mj_makeEmptyFileVFS(files_.get(), name, static_cast<int>(text.size())) == 0;
    if (made_) std::memcpy(files_->filedata[0], text.data(), text.size());
  }
  ~VirtualFile() { mj_deleteVFS(files_.get()); }
  VirtualFile(const VirtualFile&) = delete;
  VirtualFile& operator=(const VirtualFile&) = delete;

  [[nodiscard]] bool made() const { return made_; }
  [[nodiscard]] const mjVFS* get() const { return files_.get(); }

 private:
  std::unique_ptr<mjVFS> files_;  // too large for a stack
  bool made_ = false;
};

std::string body_xml(std::size_t index, const Coordinate& own) {
  if (own.radius > 0.0) {
    const double inertia = own.mass * own.radius * own.radius;
    return fmt::format(
        "<body><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"{0} {0} {0}\"/>"
        "<joint name=\"q{1}\" type=\"hinge\" axis=\"0 0 1\"/></body>\n",
        inertia, index);
  }
  // The axis points along the cable towards the last weight: down on its side, up on the other.
  return fmt::format(
      "<body><inertial pos=\"0 0 0\" mass=\"{0}\" diaginertia=\"{0} {0} {0}\"/>"
      "<joint name=\"q{1}\" type=\"slide\" axis=\"0 {2} 0\"/></body>\n",
      own.mass, index, -own.pull);
}

std::string tendon_xml(const Problem& problem, std::size_t span, const std::string& limit) {
  const auto factor = [&](std::size_t i) {
    const double r = problem.coordinates[i].radius;
    return r > 0.0 ? r : 1.0;
  };
  return fmt::format(
      "<fixed limited=\"true\" {}><joint joint=\"q{}\" coef=\"{}\"/>"
      "<joint joint=\"q{}\" coef=\"{}\"/></fixed>\n",
      limit, span, -factor(span), span + 1, factor(span + 1));
}

}  // namespace

std::string MujocoSettings::text() const {
  return fmt::format("{}, {}, {}, {} iterations, tolerance {:g}, impedance {:g}, {}{}", solver,
                     jacobian, integrator, iterations, tolerance, impedance,
                     time_constant > 0.0 ? fmt::format("time constant {:g} dt", time_constant)
                                         : std::string("within a step"),
                     warm_start ? "" : ", cold start");
}

std::string mujoco_xml(const Problem& problem, const MujocoSettings& settings) {
  const double dt = problem.dt;
  const std::string reference = settings.time_constant > 0.0
                                    ? fmt::format("{} 1", settings.time_constant * dt)
                                    : fmt::format("{} {}", -1.0 / (dt * dt), -1.0 / dt);
  // Spans start taut: a limit that is reached to the last bit, but not passed, would not act in the
  // first step.
  const std::string limit =
      fmt::format("range=\"-1000 -1e-12\" solreflimit=\"{}\" solimplimit=\"{} {} 0.001\"",
                  reference, settings.impedance, settings.impedance);
  // Scratch [numbers]: some dense matrices of the problem's size. By itself it reserves too little
  // for long trains.
  const std::size_t n = problem.coordinates.size();
  const std::size_t stack = 100'000 + 20 * n * n;
  std::string xml = fmt::format(
      "<mujoco>\n<compiler inertiafromgeom=\"false\" boundmass=\"0\" boundinertia=\"0\"/>\n"
      "<size njmax=\"{0}\" nconmax=\"1\" nstack=\"{9}\"/>\n"
      "<option timestep=\"{1}\" gravity=\"0 {2} 0\" solver=\"{3}\" jacobian=\"{4}\" "
      "integrator=\"{5}\" iterations=\"{6}\" tolerance=\"{7}\">\n"
      "<flag contact=\"disable\" equality=\"disable\" frictionloss=\"disable\" passive=\"disable\" "
      "actuation=\"disable\" clampctrl=\"disable\" sensor=\"disable\" warmstart=\"{8}\"/>\n"
      "</option>\n<worldbody>\n",
      n + 1, dt, -problem.gravity, settings.solver, settings.jacobian, settings.integrator,
      settings.iterations, settings.tolerance, settings.warm_start ? "enable" : "disable", stack);
  for (std::size_t i = 0; i < problem.coordinates.size(); ++i) {
    xml += body_xml(i, problem.coordinates[i]);
  }
  xml += "</worldbody>\n<tendon>\n";
  for (std::size_t i = 0; i + 1 < problem.coordinates.size(); ++i) {
    xml += tendon_xml(problem, i, limit);
  }
  return xml + "</tendon>\n</mujoco>\n";
}

namespace {

Result<std::unique_ptr<mjModel, ModelDeleter>> mujoco_model(const Problem& problem,
                                                            const MujocoSettings& settings) {
  // Files in memory have names of 100 characters at most.
  const VirtualFile file("problem.xml", mujoco_xml(problem, settings));
  if (!file.made()) return Error{"", "MuJoCo: no memory for the problem"};
  std::array<char, 1000> message{};
  std::unique_ptr<mjModel, ModelDeleter> model(
      mj_loadXML("problem.xml", file.get(), message.data(), static_cast<int>(message.size())));
  if (!model) return Error{"", std::string("MuJoCo: ") + message.data()};
  return model;
}

}  // namespace

Result<std::shared_ptr<Machine>> mujoco_machine(const Problem& problem,
                                                const MujocoSettings& settings) {
  auto model = mujoco_model(problem, settings);
  if (!model) return model.errors();
  std::unique_ptr<mjData, DataDeleter> data(mj_makeData(model->get()));
  if (!data) return Error{"", "MuJoCo: no memory for the state"};
  return std::shared_ptr<Machine>(std::make_shared<MujocoMachine>(
      std::move(model).value(), std::move(data), problem.coordinates));
}

Result<std::unique_ptr<MujocoWorlds>> MujocoWorlds::create(const Problem& problem,
                                                           const MujocoSettings& settings,
                                                           std::size_t count) {
  auto model = mujoco_model(problem, settings);
  if (!model) return model.errors();
  std::vector<std::unique_ptr<mjData, DataDeleter>> worlds;
  for (std::size_t i = 0; i < count; ++i) {
    worlds.emplace_back(mj_makeData(model->get()));
    if (!worlds.back()) return Error{"", "MuJoCo: no memory for the state"};
  }
  return std::unique_ptr<MujocoWorlds>(std::make_unique<ManyMujocoWorlds>(
      std::move(model).value(), std::move(worlds), problem.coordinates));
}

std::string mujoco_version() { return std::string("MuJoCo ") + mj_versionString(); }

}  // namespace sheave::peers
