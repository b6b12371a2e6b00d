#include "sim/recording/truth_file.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <stdexcept>

#include "tests/support/hostile_files.hpp"

namespace tumblesight::sim {
namespace {

const std::string kHeader =
    "sequence_number,exposure_time_ns,q_lrf_trf_w,q_lrf_trf_x,q_lrf_trf_y,q_lrf_trf_z";
const std::string kRates = ",rate_lrf_x_rad_s,rate_lrf_y_rad_s,rate_lrf_z_rad_s";

std::string refusal_of(const std::string& text) {
  try {
    (void)parse_truth(text, "a.csv");
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "accepted";
}

RecordedTruth some_truth() {
  RecordedTruth truth;
  truth.sequence_number = 4'294'967'295U;
  truth.exposure_time_ns = -9'223'372'036'854'775'807 - 1;
  truth.q_lrf_trf = Eigen::Quaterniond(0.1, -0.7, 1.0 / 3.0, 0.6).normalized();
  truth.rate_lrf_rad_s = {0.1, -1.0 / 3.0, 1e-9};
  truth.trf_origin_lrf_m = {-0.25, 99.9, 1.0 / 7.0};
  truth.target = "near_shoemaker";
  truth.sensor = {"flash_256", 0x0000BEEFU};
  return truth;
}

TEST(TruthFile, OfLongOrBinaryContentIsRefusedInAShortLine) {
  const std::string row = "\n1,2,1,0,0," + std::string(100'000, '7') + "x\n";
  const std::string value = refusal_of(kHeader + row), column = refusal_of(std::string("\1\033[2J") + row);
  const std::string name = refusal_of(kHeader + "," + std::string(100'000, 'y') + "\n");
  EXPECT_NE(value.find("q_lrf_trf_z: '777"), std::string::npos) << value;
  EXPECT_NE(value.find("777...' must be a number from -1.001"), std::string::npos) << value;
  EXPECT_NE(name.find("yyy...'; docs/icd.md lists the columns"), std::string::npos) << name;
  for (const std::string& refusal : {value, name}) EXPECT_LT(refusal.size(), 250U) << refusal;
  EXPECT_NE(column.find("there is no column '??[2J'"), std::string::npos) << column;
}

// Verifies TS-SIL-130.
TEST(TruthFile, IsReadAsItWasWritten) {
  RecordedTruth bare = some_truth();
  bare.rate_lrf_rad_s.reset();
  bare.trf_origin_lrf_m.reset();
  bare.target.clear();
  bare.sensor.reset();
  for (const RecordedTruth& written : {some_truth(), bare}) {
    const TruthTable table = parse_truth(truth_csv({written}), "a.csv");
    ASSERT_EQ(table.size(), 1U);
    const RecordedTruth& read = table.begin()->second;
    EXPECT_EQ(read.sequence_number, written.sequence_number);
    EXPECT_EQ(read.exposure_time_ns, written.exposure_time_ns);
    EXPECT_LT((read.q_lrf_trf.coeffs() - written.q_lrf_trf.coeffs()).norm(), 1e-15);
    EXPECT_EQ(read.rate_lrf_rad_s, written.rate_lrf_rad_s);
    EXPECT_EQ(read.trf_origin_lrf_m, written.trf_origin_lrf_m);
    EXPECT_EQ(read.target, written.target);
    ASSERT_EQ(read.sensor.has_value(), written.sensor.has_value());
    EXPECT_TRUE(!read.sensor || read.sensor->name == written.sensor->name);
    EXPECT_TRUE(!read.sensor || read.sensor->crc32 == written.sensor->crc32);
    EXPECT_EQ(read.line, 2U);
  }
}

TEST(TruthFile, OfNoFramesHasTheHeaderOnly) {
  EXPECT_TRUE(parse_truth(truth_csv({}), "a.csv").empty());
}

TEST(TruthFile, MayComeFromASpreadsheet) {
  const std::string text =
      "\xEF\xBB\xBF q_lrf_trf_w , q_lrf_trf_x,q_lrf_trf_y,q_lrf_trf_z,exposure_time_ns,sequence_number\r\n"
      "\r\n 0, 0.6 ,0,-8e-1,2700000000,7\r\n";
  const TruthTable table = parse_truth(text, "a.csv");
  ASSERT_EQ(table.count({7, 2'700'000'000}), 1U);
  EXPECT_EQ(table.begin()->second.q_lrf_trf.z(), -0.8);
  EXPECT_EQ(table.begin()->second.line, 3U);
}

// Verifies TS-SIL-130.
TEST(TruthFile, IsRefusedWithFileLineColumnValueLimitAndRemedy) {
  const std::pair<std::string, const char*> refusals[] = {
      {"", "a.csv, line 1: the file is empty; its first line must name the columns"},
      {kHeader + ",colour\n", "a.csv, line 1: there is no column 'colour'; docs/icd.md lists the columns"},
      {kHeader + ",q_lrf_trf_w\n", "line 1: the column q_lrf_trf_w is there twice; remove one"},
      {"sequence_number,exposure_time_ns\n", "line 1: the column q_lrf_trf_w is missing; it is required"},
      {kHeader + ",rate_lrf_y_rad_s\n",
       "line 1: the column rate_lrf_x_rad_s is missing; give all of its kind or none"},
      {kHeader + "\n1,2,1,0,0\n",
       "line 2: 5 values, but the first line names 6 columns; give a value for each"},
      {kHeader + "\n1,2,1,0,0,0,\n", "line 2: 7 values"},
      {kHeader + "\n-1,2,1,0,0,0\n",
       "line 2: sequence_number: '-1' must be a whole number from 0 to 4294967295; give that of the frame"},
      {kHeader + "\n4294967296,2,1,0,0,0\n", "sequence_number: '4294967296' must be a whole number"},
      {kHeader + "\n1,2.7e9,1,0,0,0\n",
       "exposure_time_ns: '2.7e9' must be a whole number from -9223372036854775808 to"},
      {kHeader + "\n1,,1,0,0,0\n", "exposure_time_ns: '' must be a whole number"},
      {kHeader + "\n1,2,one,0,0,0\n",
       "q_lrf_trf_w: 'one' must be a number from -1.001 to 1.001, with a point"},
      {kHeader + "\n1,2,nan,0,0,0\n", "q_lrf_trf_w: 'nan' must be a number"},
      {kHeader + "\n1,2,1.5,0,0,0\n", "q_lrf_trf_w: '1.5' must be a number from -1.001 to 1.001"},
      {kHeader + "\n1,2,0.5,0.5,0,0\n",
       "line 2: q_lrf_trf: its norm is 0.7071067811865476, which must be within 0.001 of 1"},
      {kHeader + kRates + "\n1,2,1,0,0,0,0,11,0\n", "rate_lrf_y_rad_s: '11' must be a number from -10 to 10"},
      {kHeader + ",target\n1,2,1,0,0,0,a b\n", "target: 'a b' must be 1 to 31 characters of a-z, 0-9 and _"},
      {kHeader + ",target\n1,2,1,0,0,0,\n", "target: '' must be 1 to 31 characters"},
      {kHeader + ",sensor\n", "line 1: the column sensor_crc32 is missing; give all of its kind or none"},
      {kHeader + ",sensor,sensor_crc32\n1,2,1,0,0,0,paper,12g45678\n", "must be the 8 hexadecimal digits"},
      {kHeader + ",sensor,sensor_crc32\n1,2,1,0,0,0,paper,1234567\n",
       "sensor_crc32: '1234567' must be the 8"},
      {kHeader + "\n1,2,1,0,0,0\n1,2,1,0,0,0\n",
       "line 3: sequence_number 1 with this exposure_time_ns is in line 2 too; give one line"},
  };
  for (const auto& [text, message] : refusals)
    EXPECT_NE(refusal_of(text).find(message), std::string::npos) << refusal_of(text) << "\n" << message;
}

TEST(TruthFile, HasTheColumnsOfTheInterfaceDocument) {
  std::ostringstream document;
  document << std::ifstream(TUMBLESIGHT_SOURCE_DIR "/docs/icd.md").rdbuf();
  std::istringstream header(truth_csv({}));
  for (std::string column; std::getline(header >> std::ws, column, ',');) {
    if (column.back() == '\n') column.pop_back();
    EXPECT_NE(document.str().find("`" + column + "`"), std::string::npos) << column;
  }
}

TEST(TruthFile, HasThePathOfItsRecording) {
  EXPECT_EQ(truth_path_of("a.b/frames.tslr"), "a.b/frames.truth.csv");
  EXPECT_EQ(truth_path_of("a.b/frames"), "a.b/frames.truth.csv");
  EXPECT_EQ(truth_path_of("run.1"), "run.1.truth.csv") << "run.2 has another truth";
  EXPECT_EQ(truth_path_of("run.tslr.old"), "run.tslr.old.truth.csv");
}

TEST(TruthFile, IsRefusedUnreadIfItIsNoFileOrTooLarge) {
  expect_all_refused(".csv", [](const std::string& path) { (void)read_truth(path); });
}

}  // namespace
}  // namespace tumblesight::sim
