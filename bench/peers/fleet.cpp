#include "bench/peers/fleet.h"

#include <atomic>
#include <utility>
#include <vector>

#include "python/bindings/batch.h"
#include "python/bindings/thread_pool.h"

namespace sheave::peers {
namespace {

class SheaveFleet final : public Fleet {
 public:
  SheaveFleet(std::unique_ptr<python::Batch> batch, std::vector<Coordinate> coordinates)
      : batch_(std::move(batch)),
        all_(batch_->size(), 1),
        start_(batch_->world(batch_->size() - 1).world.state()),
        coordinates_(std::move(coordinates)) {}

  [[nodiscard]] std::size_t size() const override { return batch_->size(); }
  bool restart() override { return batch_->reset(all_).empty(); }
  bool step(int steps) override {
    batch_->step(steps, all_, [] { return true; });
    for (std::size_t i = 0; i < size(); ++i) {
      if (batch_->has_diverged(i)) return false;
    }
    return true;
  }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    read_coordinates(batch_->world(size() - 1).world.state(), start_, coordinates_, positions,
                     rates);
  }

 private:
  std::unique_ptr<python::Batch> batch_;
  std::vector<char> all_;
  State start_;
  std::vector<Coordinate> coordinates_;
};

class MujocoFleet final : public Fleet {
 public:
  MujocoFleet(std::unique_ptr<MujocoWorlds> worlds, std::size_t threads)
      : worlds_(std::move(worlds)), pool_(threads) {}

  [[nodiscard]] std::size_t size() const override { return worlds_->size(); }
  bool restart() override {
    pool_.for_each(size(), [this](std::size_t i) { worlds_->restart(i); });
    return true;
  }
  bool step(int steps) override {
    std::atomic<bool> good = true;
    pool_.for_each(size(), [&](std::size_t i) {
      if (!worlds_->step(i, steps)) good = false;
    });
    return good;
  }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    worlds_->read(size() - 1, positions, rates);
  }

 private:
  std::unique_ptr<MujocoWorlds> worlds_;
  python::ThreadPool pool_;
};

class LastWorld final : public Machine {
 public:
  explicit LastWorld(std::shared_ptr<Fleet> fleet) : fleet_(std::move(fleet)) {}
  void restart() override { fleet_->restart(); }
  bool step() override { return fleet_->step(1); }
  void read(std::vector<double>& positions, std::vector<double>& rates) const override {
    fleet_->read(positions, rates);
  }

 private:
  std::shared_ptr<Fleet> fleet_;
};

}  // namespace

Result<std::shared_ptr<Fleet>> sheave_fleet(const Scene& scene, std::size_t count,
                                            std::size_t threads,
                                            std::vector<Coordinate> coordinates) {
  python::Batch::Faults faults;
  std::unique_ptr<python::Batch> batch = python::Batch::create(
      {write_scene(scene), scene.name, false}, count, {}, {}, threads, faults);
  if (batch == nullptr) return Error{"", to_string(faults.errors.front())};
  return std::shared_ptr<Fleet>(
      std::make_shared<SheaveFleet>(std::move(batch), std::move(coordinates)));
}

Result<std::shared_ptr<Fleet>> mujoco_fleet(const Problem& problem, const MujocoSettings& settings,
                                            std::size_t count, std::size_t threads) {
  auto worlds = MujocoWorlds::create(problem, settings, count);
  if (!worlds) return worlds.errors();
  return std::shared_ptr<Fleet>(std::make_shared<MujocoFleet>(std::move(worlds).value(), threads));
}

MachineError error_of(const Problem& problem, const std::shared_ptr<Fleet>& fleet) {
  LastWorld machine(fleet);
  return error_of(problem, machine);
}

}  // namespace sheave::peers
