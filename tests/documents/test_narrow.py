"""sim/training/narrow: what it keeps, and what it says to wrong input."""
import array
import pathlib
import subprocess
import sys
import tempfile
import unittest

from load_script import loaded

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCRIPT = ROOT / "sim/training/narrow"
IMAGE = ROOT / "fsw/models/near_shoemaker.float32.tsm"


def run(*arguments):
    done = subprocess.run([sys.executable, "-B", SCRIPT, *map(str, arguments)], capture_output=True, text=True)
    return done.returncode, done.stdout + done.stderr


class Narrow(unittest.TestCase):
    def test_as_wide_as_before_it_is_the_same_image(self):
        narrow = loaded(SCRIPT)
        image = IMAGE.read_bytes()
        channels = [len(numbers) for numbers in narrow.tensors_of(image, IMAGE)[1:8:2]]
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "same.tsm"
            status, text = run(IMAGE, out, "--channels", ",".join(map(str, channels)))
            self.assertEqual(status, 0, text)
            self.assertEqual(out.read_bytes(), image)

    def test_tensors_have_the_sizes_of_the_channels_and_the_checksums_hold(self):
        narrow = loaded(SCRIPT)
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "small.tsm"
            self.assertEqual(run(IMAGE, out, "--channels", "2,3,4,5")[0], 0)
            sizes = [len(numbers) for numbers in narrow.tensors_of(out.read_bytes(), out)]
            self.assertEqual(sizes[:8], [9 * 4 * 2, 2, 9 * 2 * 3, 3, 9 * 3 * 4, 4, 9 * 4 * 5, 5])
            self.assertEqual(sizes[8], 9 * 5 * sizes[9])
            self.assertEqual(sizes[9:], [len(n) for n in narrow.tensors_of(IMAGE.read_bytes(), IMAGE)][9:])

    # A network in which the next layer reads channels 0 and 2 most.
    def test_the_channels_that_are_used_most_stay_in_their_order(self):
        narrow = loaded(SCRIPT)
        weight = array.array("f", [0.0] * (9 * 4 * 2))
        for pixel, channel, output, value in ((0, 2, 0, 3.0), (8, 0, 1, -2.0), (4, 1, 0, 1.0), (4, 3, 0, -1.5)):
            weight[(pixel * 4 + channel) * 2 + output] = value
        self.assertEqual(narrow.channels_used_most(weight, 4, 2, 2), [0, 2])
        self.assertEqual(narrow.channels_used_most(weight, 4, 2, 3), [0, 2, 3])
        kept = narrow.rows_of(weight, 4, 2, [0, 2], [1])
        self.assertEqual(len(kept), 9 * 2)
        self.assertEqual(kept[8 * 2], -2.0)

    def test_wrong_input_is_named_with_a_remedy(self):
        with tempfile.TemporaryDirectory() as folder:
            out = pathlib.Path(folder) / "x.tsm"
            damaged = pathlib.Path(folder) / "damaged.tsm"
            image = bytearray(IMAGE.read_bytes())
            image[5000] ^= 1
            damaged.write_bytes(image)
            for arguments, words in (((), "give two images and --channels"),
                                     ((IMAGE, out, "--channels", "1,2"), "give 4 numbers"),
                                     ((IMAGE, out, "--channels", "1,2,3,x"), "give 4 numbers"),
                                     ((IMAGE, out, "--channels", "1,2,3,1000"), "give 1 to that many of each"),
                                     ((IMAGE, out, "--channels", "0,2,3,4"), "give 1 to that many of each"),
                                     ((folder + "/none.tsm", out, "--channels", "1,2,3,4"), "No such file"),
                                     ((damaged, out, "--channels", "1,2,3,4"), "is damaged"),
                                     ((IMAGE.with_name("near_shoemaker.tsm"), out, "--channels", "1,2,3,4"),
                                      "give TARGET.float32.tsm")):
                status, text = run(*arguments)
                self.assertNotEqual(status, 0)
                self.assertIn(words, text)
                self.assertFalse(out.exists())


if __name__ == "__main__":
    unittest.main()
