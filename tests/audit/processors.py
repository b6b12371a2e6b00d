"""The processors of the audit, with their limits. A row names a preset; its title is the preset's (CMakePresets.json), its tools
and emulator are its toolchain file's (toolchains/NAME.cmake)."""
import dataclasses
import functools
import json
import pathlib
import subprocess

from cycles import aarch64, arm, powerpc, riscv, sparc

ROOT = pathlib.Path(__file__).resolve().parents[2]


@functools.lru_cache(maxsize=None)
def presets():
    """{name: configure preset} of the processors in CMakePresets.json, in its order."""
    every = json.loads((ROOT / "CMakePresets.json").read_text())["configurePresets"]
    return {preset["name"]: preset for preset in every if preset.get("inherits") == "processor"}


@functools.lru_cache(maxsize=None)
def _toolchain(name):
    """The variables that read_toolchain.cmake prints. Needs the compiler and the emulator to be installed."""
    script = pathlib.Path(__file__).with_name("read_toolchain.cmake")
    run = subprocess.run(["cmake", f"-DTOOLCHAIN={ROOT}/toolchains/{name}.cmake", "-P", str(script)], capture_output=True, text=True)
    if run.returncode != 0:
        raise SystemExit(f"audit: {run.stderr.strip()}")
    return dict(line.split("=", 1) for line in run.stdout.splitlines())


@dataclasses.dataclass(frozen=True)
class Limit:
    """Of the time by a model of the processor, as shares of the period."""
    model: object  # cycles.pipeline.Model
    step: float  # a whole step of the recorded frames in fixed point
    longest_step: float


@dataclasses.dataclass(frozen=True)
class Processor:
    name: str  # of the preset and the toolchain file
    clock_mhz: int
    part: str  # the part that has this clock
    instructions_e6: float  # limit, of a whole step in fixed point [millions]
    limits: tuple

    @property
    def title(self):
        return presets()[self.name]["displayName"]

    @property
    def float32(self):
        """Whether the float32 reference is built: not where memory is too small for its weights."""
        return presets()[self.name].get("cacheVariables", {}).get("TUMBLESIGHT_FLOAT32") != "OFF"

    @property
    def architecture(self):
        return _toolchain(self.name)["architecture"]

    @property
    def bare_metal(self):
        return _toolchain(self.name)["board"] != ""

    @property
    def emulator(self):
        """The command that runs a program, which comes last."""
        return tuple(_toolchain(self.name)["emulator"].split(";"))

    def tool(self, name):
        """The path of a binary utility of the compiler: nm, objdump."""
        return _toolchain(self.name)["compiler"].removesuffix("g++") + name


# Verifies TS-TIM-010, TS-TIM-020, TS-TIM-030, TS-TIM-040.
ALL = (
    Processor("cortex-a53", 1200, "Zynq UltraScale+", 45, (Limit(aarch64.A53, 0.05, 0.10),)),
    Processor("cortex-a9", 667, "Zynq-7000", 65, (Limit(arm.A9, 0.05, 0.15),)),
    Processor("rv64gc", 600, "PolarFire SoC", 80, (Limit(riscv.U54, 0.10, 0.20),)),
    Processor("ppc750", 133, "RAD750", 80, (Limit(powerpc.PPC750, 0.25, 0.50),)),
    Processor("cortex-m7", 100, "SAMRH71", 41, (Limit(arm.M7_TIGHTLY_COUPLED, 0.20, 0.45), Limit(arm.M7_CACHED, 0.20, 0.45))),
    Processor("cortex-r5f", 500, "Zynq UltraScale+", 45, (Limit(arm.R5F, 0.05, 0.15),)),
    Processor("rv64", 600, "PolarFire SoC", 80, (Limit(riscv.U54, 0.10, 0.20),)),
    Processor("leon3", 100, "GR712RC class", 80, (Limit(sparc.SLOW, 0.45, 0.68), Limit(sparc.FAST, 0.35, 0.55))),
)


def by_name(name):
    for processor in ALL:
        if processor.name == name:
            return processor
    raise SystemExit(f"audit: unknown processor '{name}'; known: {', '.join(p.name for p in ALL)}")
