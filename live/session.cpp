#include "live/session.h"

#include <cmath>

#include <fmt/format.h>

#include "live/request.h"
#include "live/request_format.h"

namespace sheave::live {
namespace {

using json::Document;
using json::Kind;
using json::no_node;
using json::NodeId;

/// A number in its given form: integers without a point.
Json number_json(double value) {
  constexpr double exact = 9007199254740992.0;
  if (value == std::floor(value) && std::abs(value) <= exact) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

/// The request that was read, or null with faults.
struct Read {
  std::unique_ptr<Request> request;
  std::optional<double> id;
};

Read read_request(const Document& document, const Names& names, json::Faults& faults) {
  Read read;
  const NodeId root = document.root();
  if (root == no_node) return read;
  const NodeId id = document.member(root, "id");
  if (id != no_node && document.kind(id) == Kind::number) read.id = document.number(id);
  PartReader parts(document, faults);
  FieldReader& reader = parts.fields();
  const Variant* chosen = reader.read_type(root, any_request_format());
  if (chosen == nullptr) return read;
  for (std::size_t i = 0; i < request_types().size(); ++i) {
    const TypeEntry<Request>& type = request_types()[i];
    if (type.name != chosen->name) continue;
    read.request = type.make();
    const std::array<void*, 1> common{read.request.get()};
    // The request was created here and is not constant; settings() only gives its derived type.
    void* settings = const_cast<void*>(read.request->settings());  // NOLINT(*-const-cast)
    const ObjectFormat& format = request_formats()[i];
    reader.read_object(root, format, common, format.variant(type.name), settings);
    read.request->read_members(root, parts, names);
  }
  return read;
}

Json fault_json(const Document& document, const json::Fault& fault) {
  Json json{{"pointer", fault.pointer},
            {"column", document.location(fault.offset).column},
            {"code", code_name(fault.code)},
            {"message", fault.message}};
  if (!fault.value.empty()) json["value"] = fault.value;
  if (!fault.allowed.empty()) json["allowed"] = fault.allowed;
  return json;
}

/// The fault of a request that was read but cannot be carried out.
Json fault_json(const Document& document, const Error& error) {
  const std::string pointer = pointer_in_text(document, error.path);
  const Document::Target target = document.find(pointer);
  const NodeId node = target.node != no_node ? target.node : document.root();
  const std::string value = target.exact ? document.excerpt(node) : std::string();
  return fault_json(document,
                    {document.offset(node), pointer, error.message, value, {}, FaultCode::meaning});
}

constexpr std::string_view checksum_begin = R"(,"checksum":")";
constexpr std::string_view checksum_end = R"("})";

bool has_checksum(const Document& document) {
  const NodeId root = document.root();
  return root != no_node && document.kind(root) == Kind::object &&
         document.member(root, "checksum") != no_node;
}

/// The part of a line of a log that its checksum covers; the whole line if its end has no checksum.
std::string_view content_of(std::string_view line) {
  const std::size_t at = line.rfind(checksum_begin);
  return line.ends_with(checksum_end) ? line.substr(0, at) : line;
}

/// The fault of a line of a log. Empty if the line is unchanged and follows the last one; `chain` has
/// then taken up the line.
std::string checksum_fault_of(std::string_view line, json::ChecksumChain& chain) {
  const std::string_view content = content_of(line);
  if (content.size() == line.size()) return "a line of a log must end with its checksum";
  std::string_view mark = line.substr(content.size() + checksum_begin.size());
  mark.remove_suffix(checksum_end.size());
  json::ChecksumChain after = chain;
  std::string fault = json::checksum_fault(mark, after.add(content));
  if (fault.empty()) {
    chain = after;
  } else {
    fault += "; restore the log from a copy: no further line of this log is done";
  }
  return fault;
}

/// The request as it goes into the log, when the world was at `step`.
std::string logged_text(const Document& document, std::string_view line, std::int64_t step) {
  const NodeId root = document.root();
  const std::uint32_t begin = document.offset(root);
  std::string text(line.substr(begin, document.end_offset(root) - begin));
  if (has_checksum(document)) text = std::string(content_of(text)) + "}";
  if (document.member(root, "at_step") == no_node) {
    text.insert(1, fmt::format(R"("at_step":{},)", step));
  }
  return text;
}

}  // namespace

Session::Session(const Scene& scene, Simulation simulation, Hooks hooks, const Limits& limits,
                 std::vector<Warning> at_start)
    : state_(std::make_unique<SessionState>(scene, std::move(simulation), std::move(hooks), limits,
                                            std::move(at_start))) {
  state_->snapshots.emplace("start", state_->keep());
  state_->logged_to = state_->world.state().steps;
}

Session::~Session() = default;
Session::Session(Session&&) noexcept = default;
Session& Session::operator=(Session&&) noexcept = default;

Json Session::head(const std::optional<double>& id, bool ok) const {
  Json answer = Json::object();
  if (id) answer["id"] = number_json(*id);
  answer["ok"] = ok;
  answer["step"] = state_->world.state().steps;
  answer["time"] = state_->world.time();
  return answer;
}

std::string Session::answer(std::string_view line) {
  SessionState& state = *state_;
  const Limits& limits = state.limits;
  json::Faults faults(limits.faults);
  // Logs are read line by line.
  if (const std::size_t end = line.find('\n'); end != std::string_view::npos) {
    line = line.substr(0, end);
    faults.add({0, "", "a request must be one line", {}, {}, FaultCode::syntax});
  }
  const Document document = Document::parse(
      line, "request", {limits.line_bytes, limits.depth, limits.values, limits.faults}, faults);
  const Read read = read_request(document, state.names, faults);
  if (has_checksum(document)) {
    const std::string fault = checksum_fault_of(line, state.log_read);
    const NodeId node = document.member(document.root(), "checksum");
    if (!fault.empty()) faults.add({document.offset(node), "/checksum", fault, {}, {}});
  }
  Json list = Json::array();
  for (const json::Fault& fault : faults.in_order()) list.push_back(fault_json(document, fault));
  Json details = Json::object();
  const std::int64_t before = state.world.state().steps;
  if (list.empty()) {
    Errors errors;
    if (read.request->at_step && *read.request->at_step != static_cast<double>(before)) {
      errors.push_back({"/at_step", fmt::format("the world is at step {}", before)});
    } else {
      if (read.request->is_logged()) state.log_steps();
      errors = read.request->run(state, details);
    }
    for (const Error& error : errors) list.push_back(fault_json(document, error));
  }
  Json answer = head(read.id, list.empty());
  if (!list.empty()) {
    std::size_t omitted = faults.omitted();
    for (; list.size() > limits.faults; ++omitted) list.erase(list.size() - 1);
    answer["errors"] = std::move(list);
    if (omitted > 0) answer["omitted"] = omitted;
    return line_of(answer);
  }
  if (read.request->is_logged() && state.hooks.log) {
    state.log(logged_text(document, line, before));
  }
  state.log_steps();
  answer.update(details);
  return line_of(answer);
}

std::string Session::answer_to_long_line() const {
  Json answer = head({}, false);
  Json fault{{"pointer", ""},
             {"column", 1},
             {"code", code_name(FaultCode::too_large)},
             {"message", fmt::format("the line is too long: at most {} bytes are allowed",
                                     state_->limits.line_bytes)}};
  answer["errors"] = Json::array({std::move(fault)});
  return line_of(answer);
}

bool Session::is_running() const { return state_->running; }
std::optional<double> Session::pace() const { return state_->pace; }
bool Session::has_quit() const { return state_->has_quit; }
void Session::finish_log() { state_->log_steps(); }
const LiveWorld& Session::world() const { return state_->world; }
SessionState& Session::state() { return *state_; }

bool Session::advance() {
  std::string reason;
  const Ending ending = state_->step(reason);
  if (ending == Ending::none) return true;
  if (ending == Ending::interrupted) return false;
  state_->running = false;
  if (!state_->hooks.event) return true;
  Json event{{"event", "ended"},
             {"step", state_->world.state().steps},
             {"time", state_->world.time()},
             {"ended", ending_names[static_cast<std::size_t>(ending)]},
             {"reason", reason}};
  state_->hooks.event(line_of(event), true);
  return true;
}

}  // namespace sheave::live
