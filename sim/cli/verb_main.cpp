// tumblesight-VERB. The build defines the verb and the function that adds its options.
#include "sim/cli/verb_program.hpp"

int main(int argc, char** argv) {
  return tumblesight::sim::run_verb_program(argc, argv, TUMBLESIGHT_VERB,
                                            tumblesight::sim::TUMBLESIGHT_ADD_COMMAND);
}
