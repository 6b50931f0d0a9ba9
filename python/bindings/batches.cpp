// Batches for Python.

#include <chrono>

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include "engine/index.h"
#include "python/bindings/arguments.h"
#include "python/bindings/batch.h"
#include "python/bindings/bind.h"
#include "python/bindings/errors.h"
#include "python/bindings/overrides.h"
#include "python/bindings/warnings.h"

namespace sheave::python {
namespace {

/// A batch that only one Python thread may use at a time.
struct SharedBatch {
  std::unique_ptr<Batch> batch;
  bool runs = false;  // a thread works on the batch, with the interpreter lock released

  [[nodiscard]] Batch& get() const {
    if (runs) raise("Error", "another thread is using this batch; wait until it is done");
    return *batch;
  }
};

/// Releases the interpreter lock while a batch works.
class AtWork {
 public:
  explicit AtWork(SharedBatch& shared) : shared_(shared) {
    shared_.runs = true;
    // NOLINTNEXTLINE(cppcoreguidelines-prefer-member-initializer): only after `runs` is set
    thread_ = PyEval_SaveThread();
  }
  ~AtWork() {
    PyEval_RestoreThread(thread_);
    shared_.runs = false;
  }
  AtWork(const AtWork&) = delete;
  AtWork& operator=(const AtWork&) = delete;

  /// False if an interruption was requested; it is raised later.
  bool goes_on() {
    const auto now = std::chrono::steady_clock::now();
    if (now - looked_ < std::chrono::milliseconds(50)) return true;
    looked_ = now;
    PyEval_RestoreThread(thread_);
    interrupted_ = PyErr_CheckSignals() != 0;
    if (interrupted_) fault_.emplace();
    thread_ = PyEval_SaveThread();
    return !interrupted_;
  }
  [[nodiscard]] std::optional<py::error_already_set>& fault() { return fault_; }

 private:
  SharedBatch& shared_;
  PyThreadState* thread_ = nullptr;
  std::chrono::steady_clock::time_point looked_ = std::chrono::steady_clock::now();
  bool interrupted_ = false;
  std::optional<py::error_already_set> fault_;
};

std::unique_ptr<SharedBatch> make(const py::object& source, const py::object& name, bool is_file,
                                  const py::object& n, const py::dict& overrides,
                                  const py::dict& vary, const py::object& threads) {
  const Batch::Source from{text(source, "source"), text(name, "name"), is_file};
  const auto count = static_cast<std::size_t>(integer(n, "n", 1, 10'000'000));
  const auto cores = static_cast<std::size_t>(integer(threads, "threads", 1, 1024));
  const std::vector<Override> common = overrides_of(overrides);
  std::vector<Variation> variations;
  for (const auto& [pointer, values] : vary) {
    variations.push_back({text(pointer, "vary"), texts(values, "vary")});
    if (variations.back().values.size() != count) {
      refuse("vary", values, fmt::format("{} values", count));
    }
  }
  Batch::Faults faults;
  auto shared = std::make_unique<SharedBatch>();
  {
    const py::gil_scoped_release unlocked;
    shared->batch = Batch::create(from, count, common, variations, cores, faults);
  }
  if (!shared->batch) raise_scene_error(faults.errors);
  return shared;
}

void step_batch(SharedBatch& shared, const py::object& n, const py::object& where) {
  Batch& batch = shared.get();
  const std::int64_t count = integer(n, "n", 0, std::int64_t{1} << 53);
  const std::vector<char> chosen = mask(where, "mask", batch.size());
  std::optional<py::error_already_set> fault;
  {
    AtWork work(shared);
    batch.step(count, chosen, [&] { return work.goes_on(); });
    fault.swap(work.fault());
  }
  if (fault) throw py::error_already_set(std::move(*fault));
}

py::array observe_batch(SharedBatch& shared, const py::object& names) {
  Batch& batch = shared.get();
  const bool one = PyUnicode_Check(names.ptr());
  const std::vector<std::string> list =
      one ? std::vector{text(names, "names")} : texts(names, "names");
  QuantityList quantities(batch.quantities());
  for (const std::string& name : list) check(quantities.add(name), "UnknownNameError");
  const auto rows = static_cast<py::ssize_t>(batch.size());
  const auto width = static_cast<py::ssize_t>(quantities.size());
  py::array_t<double> values =
      one ? py::array_t<double>({rows}) : py::array_t<double>({rows, width});
  const std::span<double> target(values.mutable_data(), batch.size() * quantities.size());
  {
    const AtWork work(shared);
    batch.observe(quantities, target);
  }
  return values;
}

/// Numbers of each body of each world: an array (worlds, bodies, width), without the last dimension
/// if `width` is 1.
template <class Read>
py::array_t<double> gather(SharedBatch& shared, py::ssize_t width, const Read& read) {
  Batch& batch = shared.get();
  const auto rows = static_cast<py::ssize_t>(batch.size());
  const auto bodies = static_cast<py::ssize_t>(batch.world(0).world.state().bodies.size());
  py::array_t<double> values({rows, bodies, width});
  double* to = values.mutable_data();
  for (std::size_t i = 0; i < batch.size(); ++i) {
    for (const BodyState& body : batch.world(i).world.state().bodies) {
      const auto& numbers = read(body);
      to = std::copy(numbers.data(), numbers.data() + width, to);
    }
  }
  // Writing to a copy would change no world without a word.
  values.attr("flags").attr("writeable") = false;
  return values;
}

template <class Value, class Read>
py::array_t<Value> per_world(SharedBatch& shared, const Read& read) {
  Batch& batch = shared.get();
  py::array_t<Value> values(static_cast<py::ssize_t>(batch.size()));
  for (std::size_t i = 0; i < batch.size(); ++i) values.mutable_data()[i] = read(batch, i);
  return values;
}

std::string control_name(Batch& batch, const py::object& name) {
  std::string control = text(name, "name");
  const Errors errors = batch.control_fault(control);
  if (!errors.empty()) raise("UnknownNameError", errors);
  return control;
}

void set_batch(SharedBatch& shared, const py::object& name, const py::object& value,
               const py::object& over, const py::object& where) {
  Batch& batch = shared.get();
  const std::string control = control_name(batch, name);
  const std::vector<double> values = numbers(value, "value", batch.size());
  check(
      batch.set(control, values, optional_number(over, "over"), mask(where, "mask", batch.size())));
}

py::list save_batch(SharedBatch& shared) {
  Batch& batch = shared.get();
  py::list states;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    states.append(py::bytes(to_bytes(batch.world(i).world.state())));
  }
  return states;
}

void restore_batch(SharedBatch& shared, const py::object& states, const py::object& where) {
  Batch& batch = shared.get();
  const std::vector<char> chosen = mask(where, "mask", batch.size());
  // A tuple cannot change while its items are read.
  const auto items = py::reinterpret_steal<py::object>(PySequence_Tuple(states.ptr()));
  if (!items) PyErr_Clear();
  const auto list = items ? py::reinterpret_borrow<py::tuple>(items) : py::tuple();
  if (list.size() != batch.size()) {
    refuse("states", states, fmt::format("a list of {} states", batch.size()));
  }
  std::vector<State> wanted;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    const py::object one = list[i];
    if (chosen[i] == 0) {
      wanted.push_back(batch.world(i).world.state());
      continue;
    }
    if (!py::isinstance<py::bytes>(one)) refuse("states", one, "bytes of a state");
    wanted.push_back(value_of(state_from_bytes(one.cast<std::string>()), "StateError"));
  }
  // Restores all worlds or none.
  std::vector<State> before;
  for (std::size_t i = 0; i < batch.size(); ++i) {
    before.push_back(batch.world(i).world.state());
    const Errors errors = chosen[i] == 0 ? Errors() : batch.restore(i, wanted[i]);
    if (errors.empty()) continue;
    for (std::size_t k = 0; k < i; ++k) {
      if (chosen[k] != 0) static_cast<void>(batch.restore(k, before[k]));
    }
    raise("StateError", fmt::format("world {}: {}", i, errors.front().message));
  }
}

using BatchClass = py::class_<SharedBatch>;

void bind_batch_readers(BatchClass& batch) {
  batch.def("__len__", [](SharedBatch& own) { return own.get().size(); });
  batch.def_property_readonly("threads", [](SharedBatch& own) { return own.get().threads(); });
  batch.def_property_readonly("duration", [](SharedBatch& own) { return own.get().duration(); });
  batch.def_property_readonly(
      "dt", [](SharedBatch& own) { return own.get().world(0).world.model().step.dt; });
  batch.def_property_readonly(
      "observables", [](SharedBatch& own) { return own.get().quantities()->set().names(); });
  batch.def("observe", &observe_batch, py::arg("names"));
  batch.def_property_readonly("positions", [](SharedBatch& own) {
    return gather(own, 3, [](const BodyState& body) -> const Vector3& { return body.position; });
  });
  batch.def_property_readonly("velocities", [](SharedBatch& own) {
    return gather(own, 3, [](const BodyState& body) -> const Vector3& { return body.velocity; });
  });
  batch.def_property_readonly("angular_velocities", [](SharedBatch& own) {
    return gather(own, 3,
                  [](const BodyState& body) -> const Vector3& { return body.angular_velocity; });
  });
  batch.def_property_readonly("orientations_xyzw", [](SharedBatch& own) {
    return gather(own, 4, [](const BodyState& body) { return body.orientation.coeffs(); });
  });
  batch.def_property_readonly("time", [](SharedBatch& own) {
    return per_world<double>(own,
                             [](Batch& b, std::size_t i) { return b.world(i).world.state().time; });
  });
  batch.def_property_readonly("steps", [](SharedBatch& own) {
    return per_world<std::int64_t>(
        own, [](Batch& b, std::size_t i) { return b.world(i).world.state().steps; });
  });
  batch.def_property_readonly("hashes", [](SharedBatch& own) {
    return per_world<std::uint64_t>(
        own, [](Batch& b, std::size_t i) { return hash(b.world(i).world.state()); });
  });
  batch.def_property_readonly("diverged", [](SharedBatch& own) {
    return per_world<bool>(own, [](Batch& b, std::size_t i) { return b.has_diverged(i); });
  });
  batch.def_property_readonly("stopped", [](SharedBatch& own) {
    return per_world<bool>(own, [](Batch& b, std::size_t i) { return b.has_stopped(i); });
  });
  batch.def(
      "divergence",
      [](SharedBatch& own, const py::object& world) {
        Batch& b = own.get();
        const auto last = static_cast<std::int64_t>(b.size()) - 1;
        return b.divergence(static_cast<std::size_t>(integer(world, "world", 0, last)));
      },
      py::arg("world"));
  batch.def(
      "warnings",
      [](SharedBatch& own, const py::object& world) {
        Batch& b = own.get();
        const auto last = static_cast<std::int64_t>(b.size()) - 1;
        return warning_dicts(
            b.warnings(static_cast<std::size_t>(integer(world, "world", 0, last))));
      },
      py::arg("world"));
}

}  // namespace

void bind_batch(py::module_& module) {
  BatchClass batch(module, "Batch", "Many worlds of one scene.");
  batch.def(py::init(&make), py::arg("source"), py::arg("name"), py::arg("is_file"), py::arg("n"),
            py::arg("overrides"), py::arg("vary"), py::arg("threads"));
  batch.def("step", &step_batch, py::arg("n") = 1, py::arg("mask") = py::none());
  batch.def("set", &set_batch, py::arg("name"), py::arg("value"), py::arg("over") = py::none(),
            py::arg("mask") = py::none());
  batch.def(
      "clear",
      [](SharedBatch& own, const py::object& name, const py::object& where) {
        Batch& b = own.get();
        check(b.set(control_name(b, name), {}, {}, mask(where, "mask", b.size())));
      },
      py::arg("name"), py::arg("mask") = py::none());
  batch.def(
      "reset",
      [](SharedBatch& own, const py::object& where) {
        check(own.get().reset(mask(where, "mask", own.get().size())));
      },
      py::arg("mask") = py::none());
  batch.def(
      "mark_start",
      [](SharedBatch& own, const py::object& where) {
        own.get().mark_start(mask(where, "mask", own.get().size()));
      },
      py::arg("mask") = py::none());
  batch.def("states", &save_batch);
  batch.def("restore", &restore_batch, py::arg("states"), py::arg("mask") = py::none());
  bind_batch_readers(batch);
}

}  // namespace sheave::python
