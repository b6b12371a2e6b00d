// The ground's limits of a telecommand are those of flight: what flight accepts can be sent, and what the
// ground sends is not refused for a value that the ground could have known.
#include "sim/operations/telecommand_table.hpp"

#include <string>
#include <vector>

#include "fsw/app/command_table.hpp"
#include "fsw/app/parameter_table.hpp"
#include "sim/operations/function_names.hpp"
#include "tests/unit/fsw/app/app_fixture.hpp"

namespace tumblesight::fsw {
namespace {

using sim::ArgumentField;
using sim::TelecommandRow;

void append(std::vector<std::uint8_t>& bytes, std::uint32_t value, int count) {
  for (int i = count - 1; i >= 0; --i) bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

class GroundTable : public AppFixture {
 protected:
  GroundTable() { init_with_model(); }

  // A parameter has its own limits: the value that it has after init() is within them.
  std::uint32_t usual(const TelecommandRow& row, const ArgumentField& field, std::uint32_t parameter) const {
    if (row.function != FunctionCode::kSetParameter || field.name != "value") return field.least;
    return parameter < kTableFields ? kInitialTable.fields[parameter] : 0;
  }
  // Flight also refuses to disable what no attitude can be trusted with; the ground leaves that to it.
  static bool is_protected(const TelecommandRow& row, std::uint32_t fault) {
    return row.function == FunctionCode::kDisableResponse && fault < config::kFaultRules.size() &&
           !config::kFaultRules[fault].can_be_disabled;
  }
  std::uint32_t refused() const {
    return out->telemetry.commands_refused_by[static_cast<std::size_t>(hal::CommandRefusal::kWrongArgument)];
  }
  // With this value in a field and usual ones in the others.
  bool takes(const TelecommandRow& row, const ArgumentField& probed, std::uint32_t value) {
    std::vector<std::uint8_t> arguments;
    for (const ArgumentField& field : row.fields) {
      if (field.bytes == 0)
        arguments.insert(arguments.end(), field.least, 0);
      else
        append(arguments, field.name == probed.name ? value : usual(row, field, value), field.bytes);
    }
    // The count: events of a kind are suppressed when there are many.
    const std::uint32_t before = refused();
    step_commands({command(row.function, arguments)});
    return refused() == before;
  }
};

TEST_F(GroundTable, HasTheLimitsOfFlightForEveryNumber) {
  for (const TelecommandRow& row : sim::telecommand_table()) {
    // A proof that is wrong is refused like a slot that has no key: below.
    if (row.function == FunctionCode::kKeyActivate) continue;
    for (const ArgumentField& field : row.fields) {
      if (field.bytes == 0) continue;
      const std::uint32_t highest = field.bytes == 4 ? 0xFFFF'FFFF : (1U << (8 * field.bytes)) - 1;
      std::vector<std::uint32_t> values;
      if (field.bytes == 1) {
        // Downwards: MODEL_BEGIN with 0 empties what 2 needs.
        for (std::uint32_t value = 0; value <= highest; ++value) values.insert(values.begin(), value);
      } else if (field.bytes == 2) {
        values = {0, field.least, field.most, field.most + 1, highest};
      }
      for (const std::uint32_t value : values) {
        if (value > highest || is_protected(row, value)) continue;
        EXPECT_EQ(takes(row, field, value), value >= field.least && value <= field.most)
            << sim::name_of(row.function) << " " << field.name << " " << value;
      }
    }
  }
}

TEST_F(GroundTable, HasEverySlotOfAKey) {
  for (const TelecommandRow& row : sim::telecommand_table())
    if (row.function == FunctionCode::kKeyActivate) {
      EXPECT_EQ(row.fields[0].least, 0U);
      EXPECT_EQ(row.fields[0].most, static_cast<std::uint32_t>(hal::kCommandKeySlots - 1));
      EXPECT_EQ(row.fields[1].least, static_cast<std::uint32_t>(hal::kCommandMacBytes));
      EXPECT_EQ(row.fields[1].most, static_cast<std::uint32_t>(hal::kCommandMacBytes));
    }
}

// The fewest and the most bytes of the gate, and the functions.
TEST_F(GroundTable, HasTheBytesOfEveryTelecommand) {
  for (int function = 0; function <= 255; ++function) {
    const CommandRule* const rule = find_command(static_cast<std::uint8_t>(function));
    const TelecommandRow* own = nullptr;
    for (const TelecommandRow& row : sim::telecommand_table())
      if (static_cast<int>(row.function) == function) own = &row;
    ASSERT_EQ(rule != nullptr, own != nullptr) << function;
    if (own == nullptr) continue;
    int least = 0, most = 0;
    for (const ArgumentField& field : own->fields) {
      least += field.bytes == 0 ? static_cast<int>(field.least) : field.bytes;
      most += field.bytes == 0 ? static_cast<int>(field.most) : field.bytes;
    }
    EXPECT_EQ(least, rule->min_argument_bytes) << function;
    EXPECT_EQ(most, rule->max_argument_bytes) << function;
  }
}

}  // namespace
}  // namespace tumblesight::fsw
