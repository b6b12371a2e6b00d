"""The contents of a program: sizes by kind, forbidden symbols, floating-point arithmetic."""
import re
import subprocess

_KINDS = {"t": "text", "w": "text", "v": "read_only", "r": "read_only", "d": "data", "b": "bss"}
_SECTIONS = {".text": "text", ".rodata": "text", ".data": "data", ".bss": "data", ".sdata": "data", ".sbss": "data", ".srodata": "text"}
_FORBIDDEN = {
    "heap": r"(malloc|calloc|realloc|free|_Zn[wa][jm]\w*|_Zd[la]Pv\w*|_sbrk)",
    "exceptions": r"(__cxa_(throw|allocate_exception|begin_catch|rethrow)|_Unwind_\w+|__gxx_personality\w*)",
    "stdio": r"(v?f?s?n?printf|puts|putchar|fwrite|fopen)",
    "libm": r"((a?(sin|cos|tan)h?|atan2|exp[2m1]*|log[12]?[0p]?|pow|fmod|hypot)[fl]?)",
}
# Floating-point arithmetic per architecture. Loads and stores of floating-point registers are not arithmetic.
_FLOATING = {
    "aarch64": r"\tf(add|sub|mul|div|n?madd|n?msub|sqrt|cvt\w+|cmp|abs|neg|min|max)\b|\t[su]cvtf\b",
    "arm": r"\tv(add|sub|n?mul|div|n?ml[as]|fn?m[as]|sqrt|cmpe?|cvt\w?|abs|neg)(eq|ne|lt|gt|le|ge|mi|pl)?\.f(32|64)",
    "riscv64": r"\tf(add|sub|mul|div|sqrt|n?madd|n?msub|cvt|eq|lt|le|min|max)\.",
    "ppc": r"\tf(adds?|subs?|muls?|divs?|n?madds?|n?msubs?|ctiwz?|rsp|cmpu|neg|abs|res|rsqrte)\b",
    "sparc": r"\tf(add|sub|mul|div|sqrt|cmpe?|itos|itod|stoi|dtoi|stod|dtos|neg|abs)[sd]?\b",
}
_SOFT_FLOAT = r"__(aeabi_[fd]|aeabi_[ui]l?2[fd]|(add|sub|mul|div|float|fix)\w*[sdt]f)"


def sizes(processor, program):
    """Bytes of the project's own functions and data in the program, by kind, without the model image and the frames."""
    listing = subprocess.run([processor.tool("nm"), "-S", "-C", str(program)], check=True, capture_output=True, text=True).stdout
    total = {"text": 0, "read_only": 0, "data": 0, "bss": 0}
    for line in listing.splitlines():
        match = re.match(r"[0-9a-f]+ ([0-9a-f]+) (\w) (.*)", line)
        if match and "tumblesight::" in match[3] and match[2].lower() in _KINDS:
            total[_KINDS[match[2].lower()]] += int(match[1], 16)
    return total


def sizes_of_cfs_app(processor, build):
    """Bytes of the cFS app without the flight application that it links: its code with constants, its data without the memory of the
    model banks, and that of one bank."""
    objects = sorted((build / "fsw/programs/cfs/CMakeFiles/cfs_app.dir").rglob("*.o"))
    listing = subprocess.run([processor.tool("size"), "-A", *map(str, objects)], check=True, capture_output=True, text=True).stdout
    total = {"text": 0, "data": 0}
    for line in listing.splitlines():
        match = re.match(r"(\.\w+)\S*\s+(\d+)\s+\d+$", line)
        if match and match[1] in _SECTIONS:
            total[_SECTIONS[match[1]]] += int(match[2])
    symbols = subprocess.run([processor.tool("nm"), "-S", *map(str, objects)], check=True, capture_output=True, text=True).stdout
    banks = int(re.search(r"\w+ (\w+) [bB] TUMBLESIGHT_APP_Models$", symbols, re.MULTILINE)[1], 16)
    return {"text": total["text"], "data": total["data"] - banks, "banks": banks}


# Verifies TS-MEM-010.
def forbidden(processor, build, program):
    """{kind: symbols}: the forbidden ones that the flight libraries need or that a bare-metal program contains."""
    libraries = [path for folder in ("gnc", "fsw") for path in sorted((build / folder).rglob("*.a"))]
    undefined = subprocess.run([processor.tool("nm"), "-u", *map(str, libraries)], check=True, capture_output=True, text=True).stdout
    symbols = {line.split()[-1] for line in undefined.splitlines() if line.strip().startswith("U ")}
    if processor.bare_metal:
        listing = subprocess.run([processor.tool("nm"), str(program)], check=True, capture_output=True, text=True).stdout
        symbols |= {line.split()[-1] for line in listing.splitlines() if line.strip()}
    found = {kind: sorted(s for s in symbols if re.fullmatch(pattern, s)) for kind, pattern in _FORBIDDEN.items()}
    return {kind: names for kind, names in found.items() if names}


# Verifies TS-NUM-040.
def floating_point(processor, program):
    """The project's functions in the fixed-point program that use floating-point arithmetic."""
    listing = subprocess.run([processor.tool("objdump"), "-d", "-C", "--no-show-raw-insn", str(program)], check=True,
                             capture_output=True, text=True).stdout
    pattern = re.compile(_FLOATING[processor.architecture] + "|" + _SOFT_FLOAT)
    found, function = set(), ""
    for line in listing.splitlines():
        heading = re.match(r"[0-9a-f]+ <(.*)>:$", line)
        if heading:
            function = heading[1]
        elif "tumblesight::" in function and pattern.search(line):
            found.add(function)
    return sorted(found)
