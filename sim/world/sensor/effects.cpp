#include "sim/world/sensor/effects.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <stdexcept>

#include "sim/host/nearest_name.hpp"
#include "sim/world/sensor/effect_functions.hpp"
#include "sim/world/sensor/frame_truth.hpp"
#include "sim/world/sensor/sensor_settings.hpp"
#include "sim/world/target/panels.hpp"

namespace tumblesight::sim {
namespace {

// A parameter of the sensor takes the strength as it is.
template <auto member>
void set(double strength, SensorSettings& settings) {
  settings.*member = static_cast<std::remove_reference_t<decltype(settings.*member)>>(strength);
}

// A seed that belongs to the effect, whatever its place in the table (FNV-1a).
std::uint64_t seed_of(const EffectRow& row) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (const char* c = row.name; *c != '\0'; ++c) {
    hash = (hash ^ static_cast<unsigned char>(*c)) * 0x100000001B3ULL;
  }
  return hash;
}

EffectRandom random_of(const EffectRow& row, std::uint64_t noise_seed, const FrameTruth& truth) {
  const std::uint64_t seed = seed_of(row);
  return {Random(mix(noise_seed, seed)), Random(mix(truth.scene_seed, seed))};
}

// Calls visit(row, function, strength) for every effect that is given and acts through a `Function`.
template <class Function, class Visitor>
void for_each_given(const Effects& effects, Visitor&& visit) {
  for (const EffectRow& row : effect_table()) {
    const auto* function = std::get_if<Function>(&row.apply);
    if (function != nullptr && effects.*row.strength != 0.0) visit(row, *function, effects.*row.strength);
  }
}

std::string range_text(const EffectRow& row) {
  const std::string range = fmt::format("{:g} to {:g}", row.lowest, row.highest);
  return *row.unit == '\0' ? range : range + " " + row.unit;
}

bool is_given(const EffectRow& row, const EffectRanges& ranges) {
  return ranges.low.*row.strength != 0.0 || ranges.high.*row.strength != 0.0;
}

bool is_range(const EffectRow& row, const EffectRanges& ranges) {
  return ranges.low.*row.strength != ranges.high.*row.strength;
}

// A number that the effect takes, or 0.
std::optional<double> number_from(const EffectRow& row, const std::string& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool number = error == std::errc{} && end == text.data() + text.size();
  const bool whole = !must_be_whole(row) || value == std::floor(value);
  const bool taken = value == 0.0 || (value >= row.lowest && value <= row.highest);
  return number && whole && taken ? std::optional<double>(value) : std::nullopt;
}

double strength_from(const EffectRow& row, const std::string& text) {
  const std::optional<double> value = number_from(row, text);
  if (value && *value != 0.0) return *value;
  throw std::invalid_argument(fmt::format("effect {}: the strength must be a {} from {}{}, not '{}'",
                                          row.name, must_be_whole(row) ? "whole number" : "number",
                                          range_text(row), row.lowest < 0.0 ? ", and not 0" : "", text));
}

// "1:5", which ends at `colon`.
void take_range(const EffectRow& row, const std::string& text, std::size_t colon, EffectRanges& ranges) {
  const std::optional<double> low = number_from(row, text.substr(0, colon));
  const std::optional<double> high = number_from(row, text.substr(colon + 1));
  const bool ends_at_0 = low == 0.0 || high == 0.0;
  if (!low || !high || !(*low < *high) || (ends_at_0 && !vanishes_at_0(row))) {
    throw std::invalid_argument(
        fmt::format("effect {}: a range must be LOW:HIGH, two ascending {} from {}{}, not '{}'", row.name,
                    must_be_whole(row) ? "whole numbers" : "numbers", range_text(row),
                    vanishes_at_0(row) && row.lowest > 0.0 ? " or 0 (off)" : "", text));
  }
  ranges.low.*row.strength = *low;
  ranges.high.*row.strength = *high;
}

double drawn_strength(const EffectRow& row, const EffectRanges& ranges, Random& random) {
  const double low = ranges.low.*row.strength, high = ranges.high.*row.strength;
  if (low == high) return low;
  return must_be_whole(row) ? std::floor(random.uniform(low, high + 1.0)) : random.uniform(low, high);
}

}  // namespace

// clang-format off
const std::vector<EffectRow>& effect_table() {
  static const std::vector<EffectRow> kTable{
      {"joints", &Effects::joints, "of the limits", 0.01, 1,
       "each sequence shows the panels at angles drawn within this share of what their joints allow",
       "the targets' joints, each panel by itself", with_moved_joints},
      {"wrong_object", &Effects::wrong_object, "", 1, 1,
       "another spacecraft: each sequence shows one of the other shipped targets",
       "the shipped meshes", other_targets},
      {"sphere", &Effects::sphere, "target radii", 0.1, 1,
       "a sphere of this radius in place of the target",
       "the body without any attitude", a_sphere},
      {"part_missing", &Effects::part_missing, "parts", 1, 20,
       "the outermost parts of a sixth to a quarter of the target's radius across are missing",
       "a change that the model does not know", without_parts},
      {"panel_turn", &Effects::panel_turn, "deg", -90, 90,
       "the solar panels are turned from the model about their hinges",
       "drives that follow the Sun", with_turned_panels},
      {"rays", &Effects::rays, "a side", 16, 128,
       "a sensor of so many rays over the same field of view",
       "frame format", set<&SensorSettings::rays>},
      {"fixed_fov", &Effects::fixed_fov, "times", 0.2, 2,
       "a fixed field of view, this many times the one that fits the target at 20 m, up to 40 deg",
       "a sensor without zoom optics", set<&SensorSettings::fixed_fov>},
      {"footprint", &Effects::footprint, "rays", 0.1, 4,
       "a beam this wide: mixed ranges where it meets two surfaces within 1.5 m, lost ones at edges",
       "Tuley, Vandapel, Hebert, ICRA 2005 (mixed pixels)", set<&SensorSettings::footprint_rays>},
      {"scan_time", &Effects::scan_time, "s", 0.01, 2,
       "the rows are exposed one after the other over this time, the middle one at the frame's time",
       "scanning LiDAR", set<&SensorSettings::scan_time_s>},
      {"background", &Effects::background, "of the view", 0.01, 1,
       "a surface 30 m behind the target fills one side of the view: the Earth, a large craft",
       "geometry", add_background},
      {"debris", &Effects::debris, "m", 0.1, 10,
       "a sphere of this diameter near the target",
       "geometry", add_debris},
      {"plume", &Effects::plume, "of the rays", 0.0001, 0.5,
       "particles within 1.5 radii around the target return these rays",
       "thin uniform scatterers, first return", add_plume},
      {"panel_lobe", &Effects::panel_lobe, "deg", 1, 90,
       "solar panels return light only within this angle of their normal",
       "specular part alone (Phong, CACM 1975)", limit_panel_lobe},
      {"lobe", &Effects::lobe, "deg", 1, 90,
       "every surface returns light only within this angle of its normal",
       "specular part alone (Phong, CACM 1975)", limit_lobe},
      {"cosine", &Effects::cosine, "", 0.1, 20,
       "a return is detected with this power of the cosine of the incidence",
       "Lambert 1, glossier above (Phong, CACM 1975)", thin_by_cosine},
      {"link_budget", &Effects::link_budget, "photoelectrons", 0.01, 1000,
       "mean signal of a diffuse surface facing the sensor at 100 m; less light, fewer detections",
       "LiDAR equation, Poisson detection (Degnan, J. Geodyn. 34, 2002)", detect_photons},
      {"retroreflectors", &Effects::retroreflectors, "rays", 0.5, 20,
       "reflectors at the target's six extreme corners bloom over this radius",
       "saturated detector, crosstalk to its neighbours", add_retroreflectors},
      {"range_walk", &Effects::range_walk, "m", -2, 2,
       "weak returns are late by up to this, with 1 - cosine of the incidence",
       "leading-edge threshold", add_range_walk},
      {"range_bias", &Effects::range_bias, "m", -5, 5,
       "every range is wrong by this", "constant delay", add_range_bias},
      {"range_scale", &Effects::range_scale, "of the range", -0.1, 0.1,
       "every range is wrong by this share of itself", "clock rate", scale_ranges},
      {"fixed_pattern", &Effects::fixed_pattern, "m", 0.001, 2,
       "every pixel has a constant error of its own with this standard deviation",
       "delays of the pixels' timers", add_fixed_pattern},
      {"dropout", &Effects::dropout, "of the returns", 0.0001, 0.99,
       "these returns are missed at random", "paper, degraded sensor", set<&SensorSettings::dropout_share>},
      {"outliers", &Effects::outliers, "of the returns", 0.0001, 0.99,
       "these returns are wrong by 5 sigma to 20 m", "multipath", set<&SensorSettings::outlier_share>},
      {"noise", &Effects::noise, "times", 0.01, 20,
       "the range noise is this many times the paper's", "paper, sensor table", set<&SensorSettings::noise_factor>},
      {"false_returns", &Effects::false_returns, "of the rays", 0.0001, 0.5,
       "these rays report a place anywhere in the range gate, new in every frame",
       "dark counts and sunlight at a constant rate", add_false_returns},
      {"hot_pixels", &Effects::hot_pixels, "of the pixels", 0.0001, 0.5,
       "these pixels report dark counts, 100 m away on average, unless the return is nearer",
       "first count of a constant rate", add_hot_pixels},
      {"dead_pixels", &Effects::dead_pixels, "of the pixels", 0.0001, 0.9,
       "these pixels never report anything", "detector defects", add_dead_pixels},
      {"dead_lines", &Effects::dead_lines, "of the lines", 0.001, 0.9,
       "these rows and columns never report anything", "defects of the read-out", add_dead_lines},
  };
  return kTable;
}
// clang-format on

const EffectRow& effect_named(const std::string& name) {
  std::string known;
  std::vector<std::string> names;
  for (const EffectRow& row : effect_table()) {
    if (name == row.name) return row;
    known += (known.empty() ? "" : ", ") + std::string(row.name);
    names.emplace_back(row.name);
  }
  throw std::invalid_argument("effect '" + name + "' is unknown; the effects are: " + known +
                              did_you_mean(name, names));
}

bool must_be_whole(const EffectRow& row) {
  return row.strength == &Effects::rays || row.strength == &Effects::part_missing ||
         row.strength == &Effects::wrong_object;
}

bool vanishes_at_0(const EffectRow& row) {
  constexpr double Effects::*kOthers[] = {&Effects::wrong_object, &Effects::sphere,     &Effects::rays,
                                          &Effects::fixed_fov,    &Effects::panel_lobe, &Effects::lobe,
                                          &Effects::link_budget,  &Effects::noise};
  return std::find(std::begin(kOthers), std::end(kOthers), row.strength) == std::end(kOthers);
}

EffectRanges effect_ranges_from(const std::vector<std::string>& texts) {
  EffectRanges ranges;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    const EffectRow& row = effect_named(text.substr(0, equals));
    if (is_given(row, ranges)) throw std::invalid_argument(fmt::format("effect {} is given twice", row.name));
    const std::string strength = equals == std::string::npos ? "" : text.substr(equals + 1);
    const std::size_t colon = strength.find(':');
    if (colon != std::string::npos) {
      take_range(row, strength, colon, ranges);
    } else {
      ranges.low.*row.strength = ranges.high.*row.strength = strength_from(row, strength);
    }
  }
  return ranges;
}

Effects effects_from(const std::vector<std::string>& texts) {
  const EffectRanges ranges = effect_ranges_from(texts);
  for (const EffectRow& row : effect_table()) {
    if (!is_range(row, ranges)) continue;
    throw std::invalid_argument(fmt::format(
        "effect {}: give one strength here; a range is possible after train --effect-set", row.name));
  }
  return ranges.low;
}

std::string to_string(const EffectRanges& effects) {
  std::string text;
  for (const EffectRow& row : effect_table()) {
    if (!is_given(row, effects)) continue;
    text += fmt::format("{}{}={}", text.empty() ? "" : ",", row.name, effects.low.*row.strength);
    if (is_range(row, effects)) text += fmt::format(":{}", effects.high.*row.strength);
  }
  return text;
}

bool show_the_target(const EffectRanges& effects) {
  return effects.high.wrong_object == 0.0 && effects.high.sphere == 0.0;
}

Effects drawn(const EffectRanges& ranges, std::uint64_t seed) {
  Effects effects;
  for (const EffectRow& row : effect_table()) {
    Random random(mix(seed, seed_of(row)));
    effects.*row.strength = drawn_strength(row, ranges, random);
  }
  return effects;
}

std::string effect_explanations() {
  std::string text;
  for (const EffectRow& row : effect_table()) {
    text += fmt::format("  {:<16} {}\n  {:<16} {}\n  {:<16} model: {}\n", row.name, range_text(row), "",
                        row.explanation, "", row.source);
  }
  return text;
}

std::vector<Panel> panels_for_effect(const char* effect, const TriangleMesh& mesh) {
  std::vector<Panel> panels = find_panels(mesh);
  if (!panels.empty()) return panels;
  throw std::invalid_argument(
      fmt::format("effect {}: no solar panels are found on {}; in an OBJ, glTF or GLB file, give their "
                  "material a name with \"panel\" in it",
                  effect, mesh.name));
}

namespace {

// Angles of joints are drawn even if their share of the limits is not.
bool bodies_are_drawn(const EffectRanges& effects) {
  const auto is_drawn = [&](const EffectRow& row) {
    return std::holds_alternative<BodyEffect>(row.apply) && is_given(row, effects) &&
           (is_range(row, effects) || row.strength == &Effects::joints);
  };
  return std::any_of(effect_table().begin(), effect_table().end(), is_drawn);
}

// `number` determines what is drawn.
std::vector<TriangleMesh> changed_bodies(const EffectRanges& effects, std::uint64_t number,
                                         const std::string& target, const TriangleMesh& mesh) {
  std::vector<TriangleMesh> bodies{mesh};
  for (const EffectRow& row : effect_table()) {
    const BodyEffect* const apply = std::get_if<BodyEffect>(&row.apply);
    if (apply == nullptr || !is_given(row, effects)) continue;
    Random random(mix(number, seed_of(row)));
    const auto strength = [&] { return drawn_strength(row, effects, random); };
    std::vector<TriangleMesh> changed;
    for (const TriangleMesh& body : bodies) {
      const std::vector<TriangleMesh> more = (*apply)(strength, random, target, body);
      changed.insert(changed.end(), more.begin(), more.end());
    }
    bodies = std::move(changed);
  }
  return bodies;
}

void mark(const std::vector<Panel>& panels, TriangleMesh& mesh) {
  mesh.is_panel.assign(mesh.triangles.size(), 0);
  for (const Panel& panel : panels) {
    for (const std::size_t triangle : panel.triangles) mesh.is_panel[triangle] = 1;
  }
}

}  // namespace

std::vector<TriangleMesh> observed_bodies(const EffectRanges& effects, const std::string& target,
                                          const TriangleMesh& mesh) {
  const bool another_body = effects.high.wrong_object != 0.0 || effects.high.sphere != 0.0;
  if (effects.high.joints != 0.0 && another_body) {
    throw std::invalid_argument(
        "effect joints moves the target's panels, and wrong_object or sphere shows another body: give one of "
        "them");
  }
  std::vector<TriangleMesh> bodies;
  const std::uint64_t count = bodies_are_drawn(effects) ? kDrawnBodies : 1;
  for (std::uint64_t number = 0; number < count; ++number) {
    const std::vector<TriangleMesh> more = changed_bodies(effects, number, target, mesh);
    bodies.insert(bodies.end(), more.begin(), more.end());
  }
  if (effects.high.panel_lobe == 0.0) return bodies;
  for (TriangleMesh& body : bodies) mark(panels_for_effect("panel_lobe", body), body);
  return bodies;
}

void mark_panels(TriangleMesh& mesh) {
  const std::vector<Panel> panels = find_panels(mesh);
  if (!panels.empty()) mark(panels, mesh);
}

SensorSettings with_effects(SensorSettings settings, const Effects& effects) {
  settings.effects = effects;
  for_each_given<SensorEffect>(
      effects, [&](const EffectRow&, SensorEffect apply, double strength) { apply(strength, settings); });
  return settings;
}

bool need_surfaces(const Effects& effects) {
  return effects.panel_lobe != 0.0 || effects.lobe != 0.0 || effects.cosine != 0.0 ||
         effects.link_budget != 0.0 || effects.range_walk != 0.0;
}

void apply_to_returns(const Effects& effects, const Flash& flash, std::uint64_t noise_seed, RangeGrid& grid) {
  for_each_given<ReturnEffect>(effects, [&](const EffectRow& row, ReturnEffect apply, double strength) {
    EffectRandom random = random_of(row, noise_seed, flash.truth);
    apply(strength, flash, random, grid);
  });
}

void apply_to_readings(const SensorSettings& settings, const FrameTruth& truth, std::uint64_t noise_seed,
                       std::vector<double>& range_m) {
  for_each_given<ReadingEffect>(settings.effects,
                                [&](const EffectRow& row, ReadingEffect apply, double strength) {
                                  EffectRandom random = random_of(row, noise_seed, truth);
                                  apply(strength, settings, random, range_m);
                                });
}

}  // namespace tumblesight::sim
