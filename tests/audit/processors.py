"""The processors of the audit: their tools, their emulators, and what an estimate of time rests on."""
import dataclasses

# On the average, of every processor: assumed, neither measured nor any data sheet's.
CYCLES_PER_INSTRUCTION = 1.5


@dataclasses.dataclass(frozen=True)
class Processor:
    name: str  # of the preset
    title: str
    prefix: str  # of its compiler's tools
    emulator: tuple  # the program to run comes last
    clock_mhz: int
    part: str  # whose clock that is
    instructions_per_mac: float  # at most, of a whole step in fixed point
    share_of_period: float  # at most, likewise
    float32: bool = True  # whether its memory holds the reference's weights

    def tool(self, name):
        return f"{self.prefix}-{name}"


_SEMIHOSTED = ("-display", "none", "-monitor", "none", "-serial", "none", "-semihosting-config", "enable=on,target=native")
_SERIAL = ("-display", "none", "-monitor", "none", "-serial", "stdio")

# Verifies TS-TIM-010, TS-TIM-020, TS-TIM-030, TS-TIM-040.
ALL = (
    Processor("cortex-a53", "Cortex-A53, Linux", "aarch64-linux-gnu", ("qemu-aarch64", "-cpu", "cortex-a53"), 1200,
              "Zynq UltraScale+; dual issue, in order", 0.35, 0.10),
    Processor("cortex-a9", "Cortex-A9, Linux", "arm-linux-gnueabihf", ("qemu-arm", "-cpu", "cortex-a9"), 667,
              "Zynq-7000; dual issue, NEON in order", 0.7, 0.10),
    Processor("rv64gc", "RISC-V rv64gc, Linux", "riscv64-linux-gnu", ("qemu-riscv64",), 600,
              "PolarFire SoC, U54; single issue, in order", 3.0, 0.50),
    Processor("ppc750", "PowerPC 750, Linux, big-endian", "powerpc-linux-gnu", ("qemu-ppc", "-cpu", "750"), 133,
              "RAD750; dual issue, out of order", 3.0, 0.50),
    Processor("cortex-m7", "Cortex-M7, bare metal", "arm-none-eabi", ("qemu-system-arm", "-M", "mps2-an500", *_SEMIHOSTED, "-kernel"),
              100, "SAMRH71; dual issue, in order", 1.2, 0.25, float32=False),
    Processor("cortex-r5f", "Cortex-R5F, bare metal", "arm-none-eabi", ("toolchains/cortex-r5f-emulator", "qemu-system-arm"), 500,
              "Zynq UltraScale+; dual issue, in order", 1.25, 0.25),
    Processor("rv64", "RISC-V rv64gc, bare metal", "riscv64-unknown-elf", ("qemu-system-riscv64", "-M", "virt", "-bios", "none",
              *_SERIAL, "-kernel"), 600, "PolarFire SoC, U54; single issue, in order", 3.0, 0.50),
    Processor("leon3", "LEON3, bare metal, big-endian", "sparc64-linux-gnu", ("qemu-system-sparc", "-M", "leon3_generic", "-m", "64M",
              *_SERIAL, "-kernel"), 100, "GR712RC class; single issue, in order, with the pipelined 32×32-bit multiplier (with the "
              "16×16-bit one a product takes four cycles, and a step about 70 % of the period)", 3.0, 0.50),
)


def by_name(name):
    for processor in ALL:
        if processor.name == name:
            return processor
    raise SystemExit(f"audit: there is no processor '{name}'; there are {', '.join(p.name for p in ALL)}")
