#include "sim/recording/truth_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "sim/host/input_file.hpp"
#include "sim/host/text.hpp"

namespace tumblesight::sim {
namespace {

enum Column : std::size_t {
  kSequenceNumber,
  kExposureTime,
  kQuaternion,              // w, x, y, z
  kRate = kQuaternion + 4,  // x, y, z
  kOrigin = kRate + 3,      // x, y, z
  kTarget = kOrigin + 3,
  kSensor,  // name, CRC-32
  kSensorCrc,
  kColumns,
};

struct ColumnRow {
  std::string_view name;
  double lowest;  // of the numbers that are neither whole nor names
  double highest;
};

constexpr double kFastest_rad_s = 10.0;
constexpr double kFarthest_m = 1e5;
constexpr double kNormTolerance = 1e-3;
constexpr std::size_t kMaxName = 31;  // characters
constexpr std::size_t kCrcDigits = 8;

constexpr std::array<ColumnRow, kColumns> kTable{{{"sequence_number", 0, 0},
                                                  {"exposure_time_ns", 0, 0},
                                                  {"q_lrf_trf_w", -1.001, 1.001},
                                                  {"q_lrf_trf_x", -1.001, 1.001},
                                                  {"q_lrf_trf_y", -1.001, 1.001},
                                                  {"q_lrf_trf_z", -1.001, 1.001},
                                                  {"rate_lrf_x_rad_s", -kFastest_rad_s, kFastest_rad_s},
                                                  {"rate_lrf_y_rad_s", -kFastest_rad_s, kFastest_rad_s},
                                                  {"rate_lrf_z_rad_s", -kFastest_rad_s, kFastest_rad_s},
                                                  {"trf_origin_lrf_x_m", -kFarthest_m, kFarthest_m},
                                                  {"trf_origin_lrf_y_m", -kFarthest_m, kFarthest_m},
                                                  {"trf_origin_lrf_z_m", -kFarthest_m, kFarthest_m},
                                                  {"target", 0, 0},
                                                  {"sensor", 0, 0},
                                                  {"sensor_crc32", 0, 0}}};

template <class Number>
std::string shortest(Number number) {
  std::array<char, 32> text;
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), number);
  return {text.data(), error == std::errc{} ? end : text.data()};
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.push_back(trimmed(line.substr(0, comma)));
    if (comma == std::string_view::npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

// One file: its columns, and where the reader stands.
class Parser {
 public:
  explicit Parser(const std::string& name) : name_(name) {}

  TruthTable parse(std::string_view text) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";  // of some editors
    if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) text.remove_prefix(kByteOrderMark.size());
    TruthTable rows;
    for (line_ = 1; !text.empty(); ++line_) {
      const std::size_t end = text.find('\n');
      const std::string_view line = trimmed(text.substr(0, end));
      text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
      if (line.empty()) continue;
      places_.empty() ? read_header(split(line)) : add(row(split(line)), rows);
    }
    if (places_.empty()) refuse("the file is empty; its first line must name the columns");
    return rows;
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw std::runtime_error(name_ + ", line " + std::to_string(line_) + ": " + what);
  }
  [[noreturn]] void refuse(Column column, std::string_view value, const std::string& what) const {
    refuse(std::string(kTable[column].name) + ": '" + shortened(std::string(value)) + "' " + what);
  }

  bool has(std::size_t column) const {
    return std::find(places_.begin(), places_.end(), column) != places_.end();
  }

  void read_header(const std::vector<std::string_view>& names) {
    for (const std::string_view name : names) {
      const auto known =
          std::find_if(kTable.begin(), kTable.end(), [&](const ColumnRow& row) { return row.name == name; });
      const auto column = static_cast<std::size_t>(known - kTable.begin());
      if (known == kTable.end())
        refuse("there is no column '" + shortened(std::string(name)) + "'; docs/icd.md lists the columns");
      if (has(column)) refuse("the column " + std::string(name) + " is there twice; remove one");
      places_.push_back(column);
    }
    require_group(kSequenceNumber, kRate, true);
    require_group(kRate, kOrigin, false);
    require_group(kOrigin, kTarget, false);
    require_group(kSensor, kColumns, false);
  }

  // All columns of the group, or none where they are optional.
  void require_group(std::size_t first, std::size_t end, bool required) const {
    bool any = required;
    for (std::size_t column = first; column < end; ++column) any |= has(column);
    for (std::size_t column = first; any && column < end; ++column) {
      if (!has(column))
        refuse("the column " + std::string(kTable[column].name) + " is missing" +
               (required ? "; it is required" : "; give all of its kind or none"));
    }
  }

  RecordedTruth row(const std::vector<std::string_view>& fields) {
    if (fields.size() != places_.size())
      refuse(std::to_string(fields.size()) + " values, but the first line names " +
             std::to_string(places_.size()) + " columns; give a value for each");
    for (std::size_t i = 0; i < fields.size(); ++i) values_[places_[i]] = fields[i];
    RecordedTruth truth;
    truth.line = line_;
    truth.sequence_number = whole<std::uint32_t>(kSequenceNumber);
    truth.exposure_time_ns = whole<std::int64_t>(kExposureTime);
    truth.q_lrf_trf = {real(kQuaternion), real(kQuaternion + 1), real(kQuaternion + 2),
                       real(kQuaternion + 3)};
    const double norm = truth.q_lrf_trf.norm();
    if (!(std::abs(norm - 1.0) <= kNormTolerance))
      refuse("q_lrf_trf: its norm is " + shortest(norm) + ", which must be within " +
             shortest(kNormTolerance) + " of 1; give a unit quaternion");
    truth.q_lrf_trf.normalize();
    if (has(kRate)) truth.rate_lrf_rad_s = {real(kRate), real(kRate + 1), real(kRate + 2)};
    if (has(kOrigin)) truth.trf_origin_lrf_m = {real(kOrigin), real(kOrigin + 1), real(kOrigin + 2)};
    if (has(kTarget)) truth.target = name(kTarget);
    if (has(kSensor)) truth.sensor = {name(kSensor), crc32(kSensorCrc)};
    return truth;
  }

  template <class Number>
  Number whole(Column column) const {
    const std::string_view text = values_[column];
    Number value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size() || text.empty())
      refuse(column, text,
             "must be a whole number from " + shortest(std::numeric_limits<Number>::min()) + " to " +
                 shortest(std::numeric_limits<Number>::max()) + "; give that of the frame in the recording");
    return value;
  }

  // Of a target or a sensor.
  std::string name(Column column) const {
    const std::string_view text = values_[column];
    const bool plain =
        text.find_first_not_of("abcdefghijklmnopqrstuvwxyz0123456789_") == std::string_view::npos;
    if (!plain || text.empty() || text.size() > kMaxName)
      refuse(column, text,
             "must be 1 to 31 characters of a-z, 0-9 and _; leave the column out if it is not known");
    return std::string(text);
  }

  std::uint32_t crc32(Column column) const {
    const std::string_view text = values_[column];
    std::uint32_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
    if (error != std::errc{} || end != text.data() + text.size() || text.size() != kCrcDigits)
      refuse(column, text, "must be the 8 hexadecimal digits that `tumblesight record` shows for the sensor");
    return value;
  }

  double real(std::size_t place) const {
    const auto column = static_cast<Column>(place);
    const std::string_view text = values_[column];
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool number = error == std::errc{} && end == text.data() + text.size() && !text.empty();
    const auto& [name, lowest, highest] = kTable[column];
    if (!number || !(value >= lowest && value <= highest))
      refuse(column, text,
             "must be a number from " + shortest(lowest) + " to " + shortest(highest) +
                 ", with a point before its decimals; see the units in the column's name");
    return value;
  }

  void add(RecordedTruth truth, TruthTable& rows) const {
    const auto [place, is_new] =
        rows.emplace(std::make_pair(truth.sequence_number, truth.exposure_time_ns), truth);
    if (!is_new)
      refuse("sequence_number " + shortest(truth.sequence_number) +
             " with this exposure_time_ns is in line " + std::to_string(place->second.line) +
             " too; give one line per frame");
  }

  const std::string& name_;
  std::size_t line_ = 0;
  std::vector<std::size_t> places_;  // the column of each value of a line
  std::array<std::string_view, kColumns> values_;
};

std::string hexadecimal(std::uint32_t crc32) {
  std::array<char, kCrcDigits + 1> text;
  std::snprintf(text.data(), text.size(), "%08x", static_cast<unsigned>(crc32));
  return text.data();
}

void append(const Eigen::Vector3d& vector, std::string& line) {
  for (const double part : vector) line += ',' + shortest(part);
}

}  // namespace

std::string recording_stem(std::string recording_path) {
  constexpr std::string_view kEnd = ".tslr";
  const std::size_t size = recording_path.size();
  if (size >= kEnd.size() && recording_path.compare(size - kEnd.size(), kEnd.size(), kEnd) == 0)
    recording_path.resize(size - kEnd.size());
  return recording_path;
}

std::string truth_path_of(const std::string& recording_path) {
  return recording_stem(recording_path) + ".truth.csv";
}

std::string truth_csv(const std::vector<RecordedTruth>& rows) {
  const bool rates = rows.empty() || rows.front().rate_lrf_rad_s;
  const bool origins = rows.empty() || rows.front().trf_origin_lrf_m;
  const bool targets = rows.empty() || !rows.front().target.empty();
  const bool sensors = rows.empty() || rows.front().sensor;
  std::string text;
  for (std::size_t column = 0; column < kColumns; ++column) {
    if (column >= kRate && column < kOrigin && !rates) continue;
    if (column >= kOrigin && column < kTarget && !origins) continue;
    if (column == kTarget && !targets) continue;
    if (column >= kSensor && !sensors) continue;
    text += (column == 0 ? "" : ",") + std::string(kTable[column].name);
  }
  for (const RecordedTruth& row : rows) {
    const Eigen::Quaterniond& q = row.q_lrf_trf;
    text +=
        '\n' + shortest(row.sequence_number) + ',' + shortest(row.exposure_time_ns) + ',' + shortest(q.w());
    append(q.vec(), text);
    if (rates) append(row.rate_lrf_rad_s.value(), text);
    if (origins) append(row.trf_origin_lrf_m.value(), text);
    if (targets) text += ',' + row.target;
    if (sensors) text += ',' + row.sensor.value().name + ',' + hexadecimal(row.sensor.value().crc32);
  }
  return text + '\n';
}

TruthTable parse_truth(const std::string& text, const std::string& name) {
  return Parser(name).parse(text);
}

TruthTable read_truth(const std::string& path) {
  constexpr InputKind kTruth{"file of truth", 256U << 20};  // a million frames and more
  return parse_truth(read_text(path, kTruth), path);
}

}  // namespace tumblesight::sim
