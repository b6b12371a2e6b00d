// Telecommands as a person gives them.
#include "sim/operations/telecommand_table.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <stdexcept>

#include "sim/operations/function_names.hpp"

namespace tumblesight::sim {
namespace {

std::string failure_of(const std::string& function, const std::map<std::string, std::string>& values) {
  try {
    telecommand_of(function, values);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

// The table of docs/icd.md is made from the handlers of the flight program: | code | function | bytes | ...
TEST(TelecommandTable, HasEveryTelecommandOfTheIcdWithItsBytes) {
  std::ifstream icd(std::string(TUMBLESIGHT_SOURCE_DIR) + "/docs/icd.md");
  const std::regex row(R"(\| (\d+) \| ([A-Z_]+) \| (\d+)(?:…(\d+))? \|.*)");
  std::set<std::string> found;
  bool is_table = false;
  for (std::string line; std::getline(icd, line);) {
    is_table = (is_table || line == "<!-- functions -->") && line != "<!-- end -->";
    std::smatch match;
    if (!is_table || !std::regex_match(line, match, row)) continue;
    found.insert(match[2]);
    const auto& table = telecommand_table();
    const auto own = std::find_if(table.begin(), table.end(), [&match](const TelecommandRow& candidate) {
      return name_of(candidate.function) == match[2];
    });
    ASSERT_NE(own, table.end()) << line;
    EXPECT_EQ(std::to_string(static_cast<int>(own->function)), match[1]);
    std::uint32_t least = 0, most = 0;
    for (const ArgumentField& field : own->fields) {
      least += field.bytes == 0 ? field.least : static_cast<std::uint32_t>(field.bytes);
      most += field.bytes == 0 ? field.most : static_cast<std::uint32_t>(field.bytes);
    }
    EXPECT_EQ(std::to_string(least), match[3]) << line;
    EXPECT_EQ(std::to_string(most), match[4].matched ? match[4] : match[3]) << line;
  }
  EXPECT_EQ(found.size(), telecommand_table().size());
}

TEST(TelecommandTable, MakesBigEndianBytes) {
  const Telecommand command =
      telecommand_of("MEMORY_DUMP", {{"memory", "1"}, {"offset", "0x01020304"}, {"size", "1024"}});
  EXPECT_EQ(command.function, hal::FunctionCode::kMemoryDump);
  EXPECT_EQ(command.arguments, (std::vector<std::uint8_t>{1, 1, 2, 3, 4, 4, 0}));
  EXPECT_EQ(telecommand_of("MODEL_LOAD", {{"offset", "5"}, {"segment", "aB01"}}).arguments,
            (std::vector<std::uint8_t>{0, 0, 0, 5, 0xAB, 1}));
  EXPECT_TRUE(telecommand_of("NOOP", {}).arguments.empty());
}

TEST(TelecommandTable, NamesWhatIsWrong) {
  EXPECT_EQ(failure_of("JUMP", {}), "there is no telecommand 'JUMP'");
  EXPECT_EQ(failure_of("SET_MODE", {}), "SET_MODE: mode is missing");
  for (const char* value : {"", "0", "4", "-1", "x", "2x", " 2", "0x", "4294967296"})
    EXPECT_EQ(failure_of("SET_MODE", {{"mode", value}}),
              std::string("SET_MODE: mode '") + value + "' must be a whole number from 1 to 3");
  const std::string proof = "KEY_ACTIVATE: proof";
  EXPECT_EQ(failure_of("KEY_ACTIVATE", {{"slot", "1"}, {"proof", "00"}}).find(proof), 0U);
  EXPECT_EQ(failure_of("KEY_ACTIVATE", {{"slot", "1"}, {"proof", "zz"}}).find(proof), 0U);
  EXPECT_EQ(failure_of("TABLE_LOAD", {{"table", std::string(2058, '0')}}).find("TABLE_LOAD: table"), 0U);
}

}  // namespace
}  // namespace tumblesight::sim
