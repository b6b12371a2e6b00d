"""The worst-case stack of one step, from the call graph that the compiler writes beside each object file (-fcallgraph-info=su)."""
import re
import sys

# The functions that a call through a pointer can reach: the kernels of an instruction set and the platform's stopwatch.
_INDIRECT = re.compile(r"kernels.*(convolve|multiply|product|max_pool|average_pool)|survey_of|sum_all_depths|accumulate_all|encode_all"
                       r"|Stopwatch.*now_ns")
# The one function that asks the deadline, and what it reaches: that looks at the stopwatch, through a pointer again.
_ASKS_DEADLINE = re.compile(r"WorkBudget::look_at_deadline")
_DEADLINE = re.compile(r"Deadline::has_passed")
_STEP = re.compile(r"AttitudeInitApp::step\(")
_LIBRARIES = {"fixed": "fsw_app.dir", "float32": "fsw_app_float32.dir"}  # of the application, by its numerics
# The C interface, which the audited programs are not linked with. Its stopwatch calls its caller's function through a pointer.
_C_INTERFACE = "fsw_c.dir"
_NODE = re.compile(r'node: \{ title: "([^"]+)" label: "([^"]*)"')
_EDGE = re.compile(r'edge: \{ sourcename: "([^"]+)" targetname: "([^"]+)"')
_BYTES = re.compile(r"(\d+) bytes \((\w+)")
LIBRARY_BYTES = 128  # assumed for a function without a call graph: libgcc's 64-bit division


def read_graph(build, numerics):
    """({function: own bytes}, {function: callees}, {function: readable name})"""
    own, callees, names = {}, {}, {}
    left_out = {_C_INTERFACE, *(library for name, library in _LIBRARIES.items() if name != numerics)}
    for path in sorted(build.rglob("*.ci")):
        if not left_out.isdisjoint(path.parts):
            continue
        text = path.read_text()
        for title, label in _NODE.findall(text):
            size = _BYTES.search(label)
            if size:
                if size[2] == "dynamic" and int(size[1]) > 0 and "bounded" not in label:
                    raise SystemExit(f"audit: {label}: a stack frame without a bound")
                function = _key(title)
                own[function] = int(size[1])
                names[function] = label.split("\\n")[0]
        for source, target in _EDGE.findall(text):
            callees.setdefault(_key(source), set()).add(_key(target))
    return own, callees, names


def _key(title):
    """Functions with internal linkage keep their file in the key. Templates and inline functions have one key for all files."""
    return title.rsplit(":", 1)[-1] if ":_ZN" in title and "_GLOBAL__N_" not in title else title


# Verifies TS-MEM-030, TS-MEM-040.
def worst_case(build, numerics):
    """(bytes, the functions on the deepest path) of AttitudeInitApp::step()."""
    own, callees, names = read_graph(build, numerics)
    indirect = [function for function, name in names.items() if _INDIRECT.search(name) or _INDIRECT.search(function)]
    deadlines = [function for function, name in names.items() if _DEADLINE.search(name)]
    depth, path = {}, {}

    def visit(function, above):
        if function in above:
            raise SystemExit(f"audit: {names.get(function, function)} calls itself")
        if function in depth:
            return depth[function]
        targets = set()
        by_pointer = deadlines if _ASKS_DEADLINE.search(names.get(function, "")) else indirect
        for target in callees.get(function, ()):
            targets.update(by_pointer if target == "__indirect_call" else (target,))
        below, deepest = 0, None
        for target in sorted(targets):
            size = visit(target, above | {function})
            if size > below:
                below, deepest = size, target
        depth[function] = own.get(function, LIBRARY_BYTES) + below
        path[function] = deepest
        return depth[function]

    sys.setrecursionlimit(10000)
    steps = [function for function, name in names.items() if _STEP.search(name)]
    if len(steps) != 1:
        raise SystemExit(f"audit: {build}: found {len(steps)} call graphs of a {numerics} step")
    total = visit(steps[0], frozenset())
    way, function = [], steps[0]
    while function is not None:
        way.append((names.get(function, function), own.get(function, LIBRARY_BYTES)))
        function = path[function]
    return total, way
