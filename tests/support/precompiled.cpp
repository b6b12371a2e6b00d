// Compiles the headers that nearly every test includes, once for all of them: add_unit_test() in
// tests/support/unit_test.cmake.
