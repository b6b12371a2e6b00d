#include "sim/console/requests.hpp"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "sim/console/little_endian.hpp"
#include "sim/console/page_files.hpp"
#include "sim/console/step_json.hpp"
#include "sim/host/text.hpp"
#include "sim/json/json_text.hpp"
#include "sim/operations/fault_table.hpp"
#include "sim/operations/function_names.hpp"
#include "sim/operations/request_line.hpp"
#include "sim/operations/telecommand_table.hpp"
#include "sim/sil/run_control.hpp"

namespace tumblesight::sim {
namespace {

constexpr const char* kBytes = "application/octet-stream";
constexpr std::size_t kMostDepth = 8;
constexpr const char* kNoToken =
    "this address lacks the token: open the whole address that tumblesight console has printed";

Answer text(int status, const std::string& what) {
  return {status, "text/plain; charset=utf-8", what + "\n", ""};
}

Answer wrong_method(const Request& request, const char* allowed) {
  Answer answer = text(405, request.path + " takes " + allowed + ", not " + shortened(request.method));
  answer.allow = allowed;
  return answer;
}

// A name that is mistyped would otherwise have no effect, and nobody would be told.
void require_only(const Json& wanted, std::initializer_list<const char*> names) {
  for (const auto& [name, value] : wanted.items()) {
    const auto is_it = [&name = name](const char* known) { return name == known; };
    if (std::none_of(names.begin(), names.end(), is_it))
      throw std::invalid_argument("the request has a field '" + shortened(name) +
                                  "', which is not known here");
  }
}

// Names come from files that anyone may have written, so that they need not be UTF-8.
Answer json_answer(const Json& json) {
  return {200, "application/json", json.dump(-1, ' ', false, Json::error_handler_t::replace), ""};
}

std::optional<std::uint64_t> number_of(const std::string& query, const std::string& name) {
  const std::string value = query_value(query, name);
  std::uint64_t number = 0;
  const auto [end, error] = std::from_chars(value.data(), value.data() + value.size(), number);
  if (value.empty() || error != std::errc() || end != value.data() + value.size()) return std::nullopt;
  return number;
}

// In a time that does not tell how much of it is right.
bool are_equal(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned difference = 0;
  for (std::size_t i = 0; i < a.size(); ++i) difference |= static_cast<unsigned char>(a[i] ^ b[i]);
  return difference == 0;
}

std::string bytes_of(const gnc::RangeImage& frame) {
  std::string bytes;
  put_u16(bytes, frame.rays);
  put_u16(bytes, 0);
  put_u32(bytes, frame.fov_urad);
  const std::size_t returns = std::size_t{frame.rays} * frame.rays;
  for (std::size_t i = 0; i < returns; ++i) put_u16(bytes, frame.ranges[i]);
  return bytes;
}

std::string hex_of(const std::vector<std::uint8_t>& bytes) {
  constexpr char kDigits[] = "0123456789abcdef";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    text += kDigits[byte >> 4];
    text += kDigits[byte & 15];
  }
  return text;
}

// Of which the page makes its form.
Answer commands_answer() {
  Json commands = Json::array();
  for (const TelecommandRow& row : telecommand_table()) {
    Json fields = Json::array();
    for (const ArgumentField& field : row.fields)
      fields.push_back({{"name", field.name},
                        {"bytes", field.bytes},
                        {"least", field.least},
                        {"most", field.most},
                        {"meaning", field.meaning}});
    commands.push_back({{"name", name_of(row.function)}, {"fields", fields}});
  }
  return json_answer(commands);
}

// As it is: its limits are those of the run. Nothing nested, which would be written by recursion.
Json number_in(const Json& wanted, const char* name) {
  const Json& value = wanted.at(name);
  if (!value.is_number()) throw std::invalid_argument(std::string(name) + " must be a number");
  return value;
}

Answer faults_answer() {
  Json faults = Json::array();
  for (const FaultRow& row : fault_table())
    faults.push_back({{"name", row.name},
                      {"explanation", row.explanation},
                      {"unit", row.unit},
                      {"least", row.lowest},
                      {"most", row.highest},
                      {"whole", row.must_be_whole}});
  return json_answer({{"most_steps", kMostFaultSteps}, {"faults", faults}});
}

bool is_sent_to(const std::string& path) {
  return path == "/api/command" || path == "/api/fault";
}

// Not a name of another host that leads here.
std::string refusal_of_host(const std::string& host, int port) {
  const std::string by_number = "127.0.0.1:" + std::to_string(port);
  const std::string by_name = "localhost:" + std::to_string(port);
  if (host == by_number || host == by_name) return {};
  return "this console answers only at http://" + by_number + "/";
}

Answer no_frame(std::uint64_t step) {
  return text(404, "there is no frame of step " + std::to_string(step) +
                       ": none was sent, or it is older than the newest ones that a live console keeps");
}

}  // namespace

std::string query_value(const std::string& query, const std::string& name) {
  std::size_t at = 0;
  while (at < query.size()) {
    const std::size_t end = std::min(query.find('&', at), query.size());
    if (query.compare(at, name.size() + 1, name + "=") == 0 && at + name.size() + 1 <= end)
      return query.substr(at + name.size() + 1, end - at - name.size() - 1);
    at = end + 1;
  }
  return {};
}

Requests::Requests(const RunSource& run, ModelOf model_of, std::string token)
    : run_(run), model_of_(std::move(model_of)), token_(std::move(token)) {}

std::string Requests::refusal_of(const Request& request, int port) const {
  const std::string of_host = refusal_of_host(request.host, port);
  if (!of_host.empty()) return of_host;
  if (!request.origin.empty() && request.origin != "http://" + request.host)
    return "a page of another origin may not use this console";
  const bool is_public = page_file(request.path) != nullptr && request.path != "/";
  if (!is_public && !are_equal(query_value(request.query, "token"), token_)) return kNoToken;
  return {};
}

std::string Requests::refusal_of_foxglove(const Request& request, int port) const {
  const std::string of_host = refusal_of_host(request.host, port);
  if (!of_host.empty()) return of_host;
  return are_equal(query_value(request.query, "token"), token_) ? "" : kNoToken;
}

std::string Requests::state_text() const {
  const StepLog::State state = run_.log().state();
  return Json{{"run", state.run_id}, {"steps", state.steps}, {"ended", state.has_ended}}.dump();
}

bool Requests::takes_body_of(const Request& request, int port) const {
  return request.method == "POST" && is_sent_to(request.path) && refusal_of(request, port).empty();
}

Answer Requests::answer(const Request& request, int port) const {
  const std::string refusal = refusal_of(request, port);
  if (!refusal.empty()) return text(403, refusal);
  const bool is_read = request.method == "GET" || request.method == "HEAD";
  if (is_sent_to(request.path) && request.method != "POST") return wrong_method(request, "POST");
  try {
    if (is_sent_to(request.path)) return post_answer(request);
    Answer answer = get_answer(request);
    return is_read || answer.status == 404 ? answer : wrong_method(request, "GET, HEAD");
  } catch (const std::exception& error) {  // a recording that is damaged
    return text(500, error.what());
  }
}

Answer Requests::get_answer(const Request& request) const {
  if (const PageFile* const file = page_file(request.path))
    return {200, file->type, std::string(file->content), ""};
  if (request.path == "/api/run") return run_answer();
  if (request.path == "/api/mesh") return mesh_answer();
  if (request.path == "/api/commands") return commands_answer();
  if (request.path == "/api/faults") return faults_answer();
  if (request.path == "/api/steps") {
    const auto from = number_of(request.query, "from");
    return from ? json_answer(run_.log().rows(*from))
                : text(400, "/api/steps needs from=NUMBER, the first step that is wanted");
  }
  using Of = Answer (Requests::*)(std::uint64_t) const;
  for (const auto& [path, of] : {std::pair<const char*, Of>{"/api/step", &Requests::step_answer},
                                 {"/api/frame", &Requests::frame_answer},
                                 {"/api/depth", &Requests::depth_answer}}) {
    if (request.path != path) continue;
    const auto step = number_of(request.query, "k");
    return step ? (this->*of)(*step) : text(400, std::string(path) + " needs k=NUMBER, the number of a step");
  }
  return text(404, "there is no " + request.path + " here");
}

Answer Requests::post_answer(const Request& request) const {
  if (request.body.size() > kMostBody)
    return text(413, "the request has more than " + std::to_string(kMostBody) + " bytes");
  try {
    const Json wanted = parse_json<Json>(request.body, {kMostDepth});
    if (!wanted.is_object()) return text(400, "the request has no JSON object");
    if (request.path == "/api/command") return command_answer(wanted);
    if (request.path == "/api/fault") return fault_answer(wanted);
  } catch (const std::invalid_argument& error) {
    return text(400, error.what());
  } catch (const Json::exception&) {
    return text(400, "the request lacks a field, or one is of another type: docs/console.md");
  } catch (const RunIsBusy& error) {
    return text(503, error.what());
  } catch (const std::runtime_error& error) {
    return text(409, error.what());
  }
  return text(404, "there is no " + request.path + " here");
}

// {"name": "SET_MODE", "arguments": {"mode": "2"}}, or unchecked {"function": 3, "bytes": "09"}.
Answer Requests::command_answer(const Json& wanted) const {
  Json request;
  if (wanted.contains("function")) {
    require_only(wanted, {"function", "bytes"});
    request = {{"function", number_in(wanted, "function")},
               {"arguments", wanted.at("bytes").get<std::string>()}};
  } else {
    require_only(wanted, {"name", "arguments"});
    if (!wanted.at("arguments").is_object()) throw std::invalid_argument("arguments must be an object");
    std::map<std::string, std::string> values;
    for (const auto& [name, value] : wanted.at("arguments").items()) values[name] = value.get<std::string>();
    const Telecommand command = telecommand_of(wanted.at("name").get<std::string>(), values);
    request = {{"function", static_cast<int>(command.function)}, {"arguments", hex_of(command.arguments)}};
  }
  return run_answer_to(request);
}

// {"fault": "freeze", "steps": 5}, {"fault": "debris", "strength": 1.5, "steps": 5}
Answer Requests::fault_answer(const Json& wanted) const {
  require_only(wanted, {"fault", "strength", "steps"});
  Json request{{"fault", wanted.at("fault").get<std::string>()}, {"steps", number_in(wanted, "steps")}};
  if (wanted.contains("strength")) request["strength"] = number_in(wanted, "strength");
  return run_answer_to(request);
}

// Throws std::invalid_argument for a request that no run would take. Of others the run says itself why it has
// not taken them.
Answer Requests::run_answer_to(const Json& request) const {
  const std::string line = request.dump();
  read_request_line(line);
  const std::string answer = run_.ask(line);
  const Json said = parse_json<Json>(answer, {kMostDepth});
  if (said.contains("error")) return text(409, said.at("error").get<std::string>());
  return {200, "application/json", answer, ""};
}

Answer Requests::run_answer() const {
  const StepLog::State state = run_.log().state();
  const auto drawn = target();
  Json radius;
  if (drawn) radius = drawn->radius_m();
  return json_answer({{"source", run_.kind()},
                      {"run", state.run_id},
                      {"title", run_.title()},
                      {"target", run_.log().target()},
                      {"target_radius_m", radius},
                      {"period_s", 2.7},
                      {"steps", state.steps},
                      {"ended", state.has_ended},
                      {"first_frame", run_.first_frame()},
                      {"whole", run_.is_whole()},
                      {"fields", row_fields()},
                      {"modes", {{"0", "BOOT"}, {"1", "STANDBY"}, {"2", "RUN"}, {"3", "SAFE"}}}});
}

Answer Requests::step_answer(std::uint64_t step) const {
  const Json detail = run_.log().step(step);
  if (detail.is_null())
    return text(404, "there is no step " + std::to_string(step) + ", or it is no longer kept");
  return json_answer(detail);
}

Answer Requests::frame_answer(std::uint64_t step) const {
  const auto frame = std::make_unique<gnc::RangeImage>();
  if (!run_.frame(step, *frame)) return no_frame(step);
  return {200, kBytes, bytes_of(*frame), ""};
}

Answer Requests::depth_answer(std::uint64_t step) const {
  const auto frame = std::make_unique<gnc::RangeImage>();
  if (!run_.frame(step, *frame)) return no_frame(step);
  const auto drawn = target();
  if (!drawn) return text(404, "the target's model image is not known: give the console --model FILE");
  std::string depth = drawn->depth(*frame);
  if (depth.empty()) return text(404, "the network sees no target in this frame");
  return {200, kBytes, std::move(depth), ""};
}

Answer Requests::mesh_answer() const {
  const auto drawn = target();
  if (!drawn) return text(404, "the target's model image is not known: give the console --model FILE");
  if (drawn->mesh().empty()) return text(404, "the model image has no surface of the target");
  return {200, kBytes, drawn->mesh(), ""};
}

std::shared_ptr<const ConsoleTarget> Requests::target() const {
  const std::string name = run_.log().target();
  const std::lock_guard lock(mutex_);
  if (name == target_name_) return target_;
  target_name_ = name;
  target_.reset();
  try {
    const std::string model = model_of_(name);
    if (!model.empty()) target_ = std::make_shared<const ConsoleTarget>(model);
  } catch (const std::runtime_error&) {
    // Without it the page has no mesh, and says so.
  }
  return target_;
}

}  // namespace tumblesight::sim
