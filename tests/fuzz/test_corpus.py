"""The archives of fuzz inputs: written, read, extended and refused."""
import contextlib
import io
import pathlib
import tempfile
import unittest

import corpus


class Archive(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.archive = self.folder / "target.inputs"

    def refused(self, data):
        self.archive.write_bytes(data)
        with self.assertRaises(ValueError) as caught:
            corpus.read_archive(self.archive)
        return str(caught.exception)

    def test_any_bytes_come_back_as_they_were(self):
        inputs = {"empty": b"", "line_feeds": b"\n\n3 x\n", "all": bytes(range(256))}
        corpus.write_archive(self.archive, inputs)
        self.assertEqual(corpus.read_archive(self.archive), inputs)
        corpus.unpack(self.archive, self.folder / "out")
        self.assertEqual({path.name: path.read_bytes() for path in (self.folder / "out").iterdir()}, inputs)

    def test_the_order_of_adding_does_not_change_the_archive(self):
        corpus.write_archive(self.archive, {"b": b"2", "a": b"1"})
        self.assertEqual(self.archive.read_bytes(), b"1 a\n1\n1 b\n2\n")

    def test_only_new_contents_are_added(self):
        corpus.write_archive(self.archive, {"a": b"1"})
        new = self.folder / "new"
        new.mkdir()
        for name, content in (("x", b"1"), ("y", b"2"), ("z", b"2")):
            (new / name).write_bytes(content)
        self.assertEqual(corpus.add(self.archive, new), 1)
        self.assertEqual(set(corpus.read_archive(self.archive).values()), {b"1", b"2"})
        self.assertEqual(corpus.add(self.archive, new), 0)

    def test_an_input_added_by_name_is_listed_and_replaced(self):
        found, by_hand = self.folder / "found", self.folder / "by_hand"
        found.mkdir()
        (found / "x").write_bytes(b"1")
        corpus.add(self.archive, found)
        for content in (b"2", b"3"):
            by_hand.write_bytes(content)
            self.assertEqual(corpus.main(["add", str(self.archive), str(by_hand), "--name", "flipped"]), 0)
        self.assertEqual(corpus.named(self.archive), {"flipped": b"3"})
        self.assertEqual(set(corpus.read_archive(self.archive).values()), {b"1", b"3"})
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            self.assertEqual(corpus.main(["list", str(self.archive)]), 0)
        self.assertEqual(output.getvalue().split(), ["1", "flipped"])

    def test_a_malformed_archive_is_refused_with_the_place(self):
        self.assertIn("byte 0: expected a line", self.refused(b"no size\n"))
        self.assertIn("byte 0: expected a line", self.refused(b"3 name without an end"))
        self.assertIn("byte 4: the 9 bytes of input 'a'", self.refused(b"9 a\nshort\n"))
        self.assertIn("twice", self.refused(b"1 a\n1\n1 a\n2\n"))
        with self.assertRaises(ValueError):
            corpus.write_archive(self.archive, {"two words": b""})

    def test_every_archive_of_the_repository_can_be_read(self):
        archives = sorted((pathlib.Path(__file__).parent / "corpus").glob("*.inputs"))
        self.assertGreater(len(archives), 0)
        for archive in archives:
            self.assertGreater(len(corpus.read_archive(archive)), 0, archive)


if __name__ == "__main__":
    unittest.main()
