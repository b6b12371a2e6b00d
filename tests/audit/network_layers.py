"""The network's table of layers (gnc/rcnn/network_shape.hpp), read by compiling a program that prints it."""
import collections
import functools
import pathlib
import re
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
Layer = collections.namedtuple("Layer", "part name macs type")  # part: cnn, lstm or head


@functools.lru_cache(maxsize=None)
def layers():
    """In the order of execution."""
    source = pathlib.Path(__file__).with_suffix(".cpp")
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "network_layers"
        subprocess.run(["g++", "-std=c++17", f"-I{ROOT}", str(source), "-o", str(program)], check=True)
        lines = subprocess.run([str(program)], check=True, capture_output=True, text=True).stdout.splitlines()
    rows = (line.split(" ", 3) for line in lines)
    return tuple(Layer(part, name, int(macs), type_) for part, name, macs, type_ in rows)


def macs():
    """Multiply-accumulates per frame."""
    return sum(layer.macs for layer in layers())


def function(layer):
    """A pattern of the function that runs the layer, in either numerics."""
    return re.escape(layer.type).replace("FixedPoint", r"\w+") + r"::(forward|hidden|output)\("
