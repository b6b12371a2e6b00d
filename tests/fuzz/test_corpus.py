"""The archives of fuzz inputs: written, read, extended and refused."""
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
        new, known = self.folder / "new", self.folder / "known"
        for path, content in ((new / "x", b"1"), (new / "y", b"2"), (new / "z", b"3"), (known / "seed", b"3")):
            path.parent.mkdir(exist_ok=True)
            path.write_bytes(content)
        self.assertEqual(corpus.add(self.archive, new, known), 1)
        self.assertEqual(set(corpus.read_archive(self.archive).values()), {b"1", b"2"})
        self.assertEqual(corpus.add(self.archive, new, known), 0)

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
