// Requests and messages of the console's clients: any bytes as a body, and as messages of one Foxglove
// session. An answer always has a status, deep JSON is refused, and what is passed to the run is an object of
// known fields.
#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <string_view>

#include "sim/console/foxglove_session.hpp"
#include "sim/console/requests.hpp"
#include "tests/fuzz/fuzz.hpp"
#include "tests/support/growing_run.hpp"

namespace tumblesight::fuzz {
namespace {

constexpr int kPort = 7320;

class AskedRun final : public sim::RunSource {
 public:
  AskedRun() { run_.add_step(); }
  const sim::StepLog& log() const override { return run_.log(); }
  const char* kind() const override { return run_.kind(); }
  std::string title() const override { return run_.title(); }
  std::uint64_t first_frame() const override { return 0; }
  bool frame(std::uint64_t step, gnc::RangeImage& frame) const override { return run_.frame(step, frame); }
  std::string ask(const std::string& request) const override {
    const sim::Json asked = sim::Json::parse(request);
    require(asked.contains("fault") || asked.contains("function"),
            "a request is for a fault or a telecommand");
    for (const auto& [name, value] : asked.items())
      require(!value.is_structured(), "a run is asked with numbers and text");
    return R"({"step":1})";
  }

 private:
  sim::test::GrowingRun run_;
};

void post(const sim::Requests& requests, const char* path, const std::string& body) {
  const std::set<int> known = {200, 400, 409, 413};
  const sim::Answer answer = requests.answer({"POST", path, "token=abc", "127.0.0.1:7320", "", body}, kPort);
  require(known.count(answer.status) == 1, "a request has an answer");
}

}  // namespace
}  // namespace tumblesight::fuzz

// Messages are separated by bytes 0.
int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace tumblesight;
  using namespace tumblesight::fuzz;
  static const AskedRun run;
  static const sim::Requests requests(
      run, [](const std::string&) { return std::string(); }, "abc");
  const std::string all(reinterpret_cast<const char*>(data), size);
  post(requests, "/api/command", all);
  post(requests, "/api/fault", all);
  sim::FoxgloveSession session(run);
  session.begin();
  for (std::size_t begin = 0; begin <= all.size();) {
    const std::size_t end = std::min(all.find('\0', begin), all.size());
    require(session.receive(std::string_view(all).substr(begin, end - begin)).size() <= 1,
            "one answer to a message");
    for (const auto& message : session.poll()) require(!message.bytes.empty(), "no message is empty");
    begin = end + 1;
  }
  return 0;
}
