// Requirement: the instruction set chosen at start-up runs on the processor of the machine.
#include "gnc/numerics/instruction_set.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace tumblesight::gnc {
namespace {

TEST(InstructionSets, HaveDistinctNames) {
  std::set<std::string> names;
  for (const InstructionSet set : kInstructionSets) names.insert(to_string(set));
  EXPECT_EQ(names.size(), kInstructionSets.size());
  EXPECT_EQ(names.count("unknown"), 0U);
  EXPECT_STREQ(to_string(static_cast<InstructionSet>(200)), "unknown");
}

TEST(InstructionSets, AreListedInTheOrderOfTheEnumeration) {
  for (std::size_t i = 0; i < kInstructionSets.size(); ++i)
    EXPECT_EQ(static_cast<std::size_t>(kInstructionSets[i]), i);
}

TEST(ProcessorHas, ThePortableSetAlways) {
  EXPECT_TRUE(processor_has(InstructionSet::kPortable));
}

#if defined(__x86_64__)
TEST(ProcessorHas, NoUnknownSet) {
  EXPECT_FALSE(processor_has(static_cast<InstructionSet>(200)));
}
#endif

TEST(ProcessorHas, TheSetsThatASetIncludes) {
  const auto implies = [](InstructionSet larger, InstructionSet smaller) {
    return !processor_has(larger) || processor_has(smaller);
  };
  EXPECT_TRUE(implies(InstructionSet::kAvxVnni, InstructionSet::kAvx2));
  EXPECT_TRUE(implies(InstructionSet::kAvx512, InstructionSet::kAvx2));
  EXPECT_TRUE(implies(InstructionSet::kAvx512Vnni, InstructionSet::kAvx512));
}

}  // namespace
}  // namespace tumblesight::gnc
