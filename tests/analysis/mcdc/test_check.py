import pathlib
import tempfile
import unittest

import check
import decisions

CODE = """namespace {
// if (no && decision)
bool a_or_b(int a,
            int b) {
  return a > 0 ||
         (b < 3 && f(a, b) == "||"[0]);
}
}  // namespace
void Thing<N>::go(int a) const {
  static_assert(kOne && kTwo);
  for (int i = 0; i < a && is_on(); ++i) step();
  const bool both = a == 1 && !off(), one = a >= 2;
  return both && one ? 1 : 2;
}
"""
PAGE = """2 tables, 1 of them with 2 conditions.
## fsw/app/one.cpp

| function | decision | condition | where its truth decides | where its falsehood decides |
|---|---|---|---|---|
| `f` | `a \\|\\| b` | `a` | One.Is (first row) | One.IsNot |
| | | `b` | One.Is | One.IsNot |
"""


class Decisions(unittest.TestCase):
    def test_each_is_found_with_its_function_and_conditions(self):
        found = [(one.function, one.text, [condition.text for condition in one.conditions]) for one in decisions.decisions_in(CODE)]
        self.assertEqual([one[0] for one in found], ["a_or_b", "go", "go", "go"])
        self.assertEqual([len(one[2]) for one in found], [3, 2, 2, 2])
        self.assertEqual(found[0][2][:2], ["a > 0", "b < 3"])
        self.assertEqual([one[1] for one in found[1:]], ["i < a && is_on()", "a == 1 && !off()", "both && one"])

    def test_a_function_with_an_attribute_is_found(self):
        code = "bool a(int x) {\n  return x;\n}\n[[gnu::noinline]] bool b(int x) {\n  return x > 0 && x < 9;\n}\n"
        self.assertEqual([one.function for one in decisions.decisions_in(code)], ["b"])

    def test_conditions_stand_where_they_say(self):
        for one in decisions.decisions_in(CODE):
            for condition in one.conditions[:2]:
                self.assertEqual(CODE[condition.begin:condition.end], condition.text)


class Check(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = pathlib.Path(self.folder.name)
        self.write("docs/mcdc.md", PAGE)
        self.write("fsw/app/one.cpp", "bool f(bool a, bool b) {\n  return a || b;\n}\n")
        self.write("tests/unit/fsw/app/one_test.cpp", "TEST(One, Is) {}\nTEST_F(One, IsNot) {}\n")

    def write(self, name, text):
        (self.root / name).parent.mkdir(parents=True, exist_ok=True)
        (self.root / name).write_text(text, encoding="utf-8")

    def expect(self, *words):
        wrong = "\n".join(check.check(self.root))
        self.assertEqual(bool(wrong), bool(words), wrong)
        for word in words:
            self.assertIn(word, wrong)

    def test_a_page_that_fits_passes(self):
        self.expect()

    def test_a_test_that_is_gone_is_named(self):
        self.write("tests/unit/fsw/app/one_test.cpp", "TEST(One, Is) {}\n")
        self.expect("no test One.IsNot")

    def test_a_condition_that_is_missing_is_named(self):
        self.write("docs/mcdc.md", "\n".join(PAGE.splitlines()[:-1]))
        self.expect("lacks `b`")

    def test_a_decision_that_has_changed_is_named_from_both_sides(self):
        self.write("fsw/app/one.cpp", "bool f(bool a, bool b) {\n  return a && b;\n}\n")
        self.expect("lacks `a` of `a && b`", "has no `a` of `a || b`")

    def test_a_decision_in_another_function_is_none_of_the_page(self):
        self.write("fsw/app/one.cpp", "bool g(bool a, bool b) {\n  return a || b;\n}\n")
        self.expect("g(): docs/mcdc.md lacks")

    def test_a_wrong_number_is_reported(self):
        self.write("docs/mcdc.md", PAGE.replace("2 conditions", "3 conditions"))
        self.expect("1 decisions with 2 conditions")

    def test_a_value_without_influence_needs_its_reason(self):
        self.write("docs/mcdc.md", PAGE.replace("| One.Is |", "| none (b is never false) |"))
        self.expect()
        self.write("docs/mcdc.md", PAGE.replace("| One.Is |", "| none |"))
        self.expect("docs/mcdc.md:7", "lacks `b`")

    def test_a_row_without_a_test_is_reported(self):
        self.write("docs/mcdc.md", PAGE.replace("| One.Is |", "| nobody knows |"))
        self.expect("docs/mcdc.md:7", "lacks `b`")


if __name__ == "__main__":
    unittest.main()
