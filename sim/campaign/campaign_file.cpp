#include "sim/campaign/campaign_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <stdexcept>

#include "sim/host/nearest_name.hpp"
#include "sim/host/text.hpp"
#include "sim/mission/toml_fields.hpp"
#include "sim/mission/toml_text.hpp"

namespace tumblesight::sim {
namespace {

namespace fs = std::filesystem;

constexpr int kMostSequences = 10'000'000;
constexpr int kFewestPerTask = 1;
constexpr int kMostPerTask = 1'000'000;
constexpr int kUsualPerTask = 2000;  // a minute, or less
constexpr std::size_t kMostRuns = 1000;
constexpr std::size_t kLongestName = 120;

// What the campaign sets itself, or what is not one cell of figures.
constexpr const char* kNotForRuns[] = {
    "shard",       "shard-file", "json",         "csv",         "report", "threads",           "paper",
    "mesh-folder", "out",        "effect-limit", "no-baseline", "curves", "baseline-sequences"};

struct Option {
  std::string key;
  std::vector<std::string> values;  // one, or those of a list; "true" alone: a flag
  bool is_flag = false;
  bool is_list = false;
};

// None: it is neither a text nor a number.
std::optional<std::string> text_of(const toml::node& node) {
  if (const auto text = node.value_exact<std::string>()) return *text;
  if (const auto whole = node.value_exact<std::int64_t>()) return std::to_string(*whole);
  if (const auto number = node.value_exact<double>()) return fmt::format("{}", *number);
  return std::nullopt;
}

Option option_of(TomlFields& fields, const std::string& key) {
  constexpr const char* kLimits = "a text, a number, true, or a list of texts or numbers that is not empty";
  Option option{key, {}, false, false};
  const toml::node& node = *fields.node(key);
  if (node.is_boolean()) {
    if (!*node.value<bool>()) fields.refuse(key, "true; leave it out for false");
    option.is_flag = true;
    option.values = {"true"};
    return option;
  }
  const auto take = [&](const toml::node& element) {
    const std::optional<std::string> text = text_of(element);
    // An empty text in a list is a run without the option.
    if (!text || (text->empty() && !option.is_list)) fields.refuse(key, kLimits);
    option.values.push_back(*text);
  };
  option.is_list = node.is_array();
  if (!option.is_list) {
    take(node);
    return option;
  }
  for (const toml::node& element : *node.as_array()) take(element);
  if (option.values.empty()) fields.refuse(key, kLimits);
  return option;
}

// TOML keeps no order of keys: what is observed comes first, then how, then the rest.
std::size_t rank_of(const std::string& key) {
  constexpr const char* kFirst[] = {"mission", "target", "mesh", "model", "condition", "effect"};
  return static_cast<std::size_t>(std::find(std::begin(kFirst), std::end(kFirst), key) - std::begin(kFirst));
}

std::vector<Option> options_of(TomlFields& fields) {
  std::vector<Option> options;
  for (const std::string& key : fields.keys()) {
    if (key == "sequences") continue;
    if (key == "seed")
      fields.fail(key, "one seed is for all runs: write it at the top of the file, before [[run]]");
    const auto* end = std::end(kNotForRuns);
    if (std::find(std::begin(kNotForRuns), end, key) != end)
      fields.fail(key, fmt::format("{} is not for a campaign: it makes figures of all sequences, or divides "
                                   "them, itself; leave it out",
                                   key));
    options.push_back(option_of(fields, key));
  }
  std::stable_sort(options.begin(), options.end(),
                   [](const Option& a, const Option& b) { return rank_of(a.key) < rank_of(b.key); });
  return options;
}

std::string word_of(const std::string& text) {
  std::string word;
  for (const char c : fs::path(text).filename().string()) {
    const bool keeps = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '.';
    if (keeps || (!word.empty() && word.back() != '_')) word += keeps ? c : '_';
  }
  return word;
}

// What is observed, conditions and effects are plain words, files by their stems; other values follow their
// key.
std::string words_of(const Option& option, const std::string& value) {
  if (option.is_flag) return option.key;
  if (option.key == "target" || option.key == "condition" || option.key == "effect") return word_of(value);
  if (option.key == "mission" || option.key == "mesh") return word_of(fs::path(value).stem().string());
  return option.key + "_" + word_of(value);
}

// All combinations, the last option fastest.
void expand(const std::vector<Option>& options, std::size_t from, const CampaignRun& so_far,
            std::vector<CampaignRun>& runs) {
  if (from == options.size()) {
    runs.push_back(so_far);
    return;
  }
  const Option& option = options[from];
  for (const std::string& value : option.values) {
    CampaignRun run = so_far;
    if (!value.empty()) {
      run.options.push_back("--" + option.key);
      if (!option.is_flag) run.options.push_back(value);
      run.keys.emplace_back(option.key, option.is_flag ? std::nullopt : std::optional<std::string>(value));
      const std::string words = words_of(option, value);
      if (words != run.name)
        run.name += (run.name.empty() ? "" : "-") + words;  // a mesh named for its target
    }
    expand(options, from + 1, run, runs);
  }
}

// Before there are any: six lists of twenty values are 64 million.
void require_not_too_many(const TomlFields& fields, const std::vector<Option>& options) {
  std::size_t runs = 1;
  for (const Option& option : options) {
    runs *= option.values.size();
    if (runs > kMostRuns)
      fields.fail("run", fmt::format("more than {} runs; divide the campaign into several files", kMostRuns));
  }
}

// A key that every run needs is missing: one that is near it names what is wrong.
void require_not_misspelt(const TomlFields& fields, const std::string& missing) {
  for (const std::string& key : fields.keys()) {
    const std::string meant = did_you_mean(key, {missing});
    if (!meant.empty())
      fields.fail(key, fmt::format("there is no key '{}'{}", fields.full(shortened(key)), meant));
  }
}

std::vector<CampaignRun> runs_of_table(TomlFields fields, std::int64_t seed, int line) {
  const auto sequences = fields.whole_number("sequences", 1, kMostSequences);
  if (!sequences) require_not_misspelt(fields, "sequences");
  if (!sequences)
    fields.refuse("sequences", fmt::format("a whole number from 1 to {}: of each run", kMostSequences));
  CampaignRun run;
  run.sequences = static_cast<std::uint32_t>(*sequences);
  run.line = line;
  run.options = {"--sequences", std::to_string(run.sequences), "--seed", std::to_string(seed)};
  const std::vector<Option> options = options_of(fields);
  require_not_too_many(fields, options);
  std::vector<CampaignRun> runs;
  expand(options, 0, run, runs);
  return runs;
}

void make_names_unique(std::vector<CampaignRun>& runs) {
  std::set<std::string> names;
  for (CampaignRun& run : runs) {
    if (run.name.empty()) run.name = "default";
    run.name = run.name.substr(0, kLongestName);
    const std::string first = run.name;
    for (int number = 2; !names.insert(run.name).second; ++number)
      run.name = first + "-" + std::to_string(number);
  }
}

toml::table parsed(const std::string& path) {
  if (!fs::exists(path)) throw std::runtime_error(fmt::format("campaign '{}': there is no such file", path));
  return parse_toml(read_toml(path, "campaign"), path);
}

}  // namespace

Campaign read_campaign(const std::string& path) {
  const toml::table table = parsed(path);
  Campaign campaign;
  campaign.file = fs::absolute(path).lexically_normal().string();
  campaign.folder = fs::path(campaign.file).parent_path().string();
  campaign.name = fs::path(path).stem().string();
  TomlFields fields(table, path, "");
  fields.require_known({{"seed", "sequences_per_task"}, {"[[run]]"}});
  const auto seed = fields.whole_number("seed", 0, 2'000'000'000);
  const auto per_task = fields.whole_number("sequences_per_task", kFewestPerTask, kMostPerTask);
  campaign.sequences_per_task = static_cast<std::uint32_t>(per_task.value_or(kUsualPerTask));
  const toml::node* runs = fields.node("run");
  if (runs == nullptr || !runs->is_array_of_tables() || runs->as_array()->empty())
    fields.refuse("run", "one or more tables [[run]] with the options of `tumblesight evaluate`");
  for (const toml::node& run : *runs->as_array()) {
    const int line = static_cast<int>(run.source().begin.line);
    for (CampaignRun& one : runs_of_table(TomlFields(*run.as_table(), path, "run"), seed.value_or(1), line))
      campaign.runs.push_back(std::move(one));
    if (campaign.runs.size() > kMostRuns)
      fields.fail("run", fmt::format("more than {} runs; divide the campaign into several files", kMostRuns));
  }
  make_names_unique(campaign.runs);
  return campaign;
}

}  // namespace tumblesight::sim
