#!/usr/bin/env python3
"""Checks that docs/requirements.csv, the documents and the tests agree, and lists what verifies each requirement.

  tests/documents/check_requirements.py                                 checks; run by ctest
  tests/documents/check_requirements.py --write build/verification.md   checks and writes the list; the packages have it

A test names the requirements that it verifies in a comment of its own, "Verifies TS-NUM-010, TS-NUM-020." after // or #. The
comment is directly above the test, or at the head of the file for all its tests.
"""
import argparse
import collections
import csv
import pathlib
import re
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = ["id", "text", "rationale", "verification"]
METHODS = {"T": "test", "A": "analysis", "I": "inspection"}
GROUPS = {
    "EST": "Attitude estimation", "LID": "LiDAR frames and depth image", "NUM": "Numerics", "TIM": "Time", "MEM": "Memory",
    "IFC": "Interfaces", "MODE": "Modes", "CMD": "Commands", "TLM": "Telemetry", "FDIR": "Faults", "MDL": "Model banks",
    "SEC": "Security", "RST": "Resets", "SIL": "Software in the loop", "TRN": "Training and quantization",
}
_ID = re.compile(r"TS-(?:%s)-\d{3}" % "|".join(GROUPS))
_DOCUMENT = re.compile(r"(?<![\w/])(?:docs|fsw|gnc|hal|sim|tests)/[\w./-]*\w")

_SOURCES = {".cpp", ".hpp", ".c", ".py", ".cmake", ".txt", ".sh", ""}
_COMMENT = {"C++": re.compile(r"\s*//(.*)"), "other": re.compile(r"\s*#(.*)")}
_VERIFIES = re.compile(r"\s*Verifies\b(.*)")
_BESIDE = re.compile(r"\bVerifies TS-")
_TEST = re.compile(r"\s*(?:TEST|TEST_F|TEST_P|TYPED_TEST)\(\s*(\w+),\s*(\w+)\)")
_INSTANTIATED = re.compile(r"\s*INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)")
_ADDED = re.compile(r"\s*add_test\(NAME\s+(\S+)")
_METHOD = re.compile(r"\s+def (test\w*)\(")
_CLASS = re.compile(r"class (\w+)\(")

Requirement = collections.namedtuple("Requirement", COLUMNS)
Claim = collections.namedtuple("Claim", "path line id test")  # test: suite.name; empty for the whole file


def read_requirements(root, wrong):
    """{id: Requirement} in the file's order. Malformed rows are reported in `wrong` and left out."""
    found = {}
    with open(root / "docs/requirements.csv", newline="", encoding="utf-8") as file:
        rows = csv.reader(file)
        if next(rows, None) != COLUMNS:
            wrong.append(f"docs/requirements.csv:1: the columns must be {','.join(COLUMNS)}")
            return found
        for row in rows:
            at = f"docs/requirements.csv:{rows.line_num}"
            if len(row) != len(COLUMNS):
                wrong.append(f"{at}: {len(row)} fields instead of {len(COLUMNS)}")
                continue
            one = Requirement(*row)
            if not _ID.fullmatch(one.id):
                wrong.append(f"{at}: '{one.id}' is not an id: TS-<group>-<three digits>, groups {' '.join(GROUPS)}")
            elif one.id in found:
                wrong.append(f"{at}: {one.id} is in the table twice")
            elif " shall " not in one.text or not one.text.endswith("."):
                wrong.append(f"{at}: {one.id}: the text is not a sentence with 'shall'")
            elif not one.rationale:
                wrong.append(f"{at}: {one.id} has no rationale")
            elif one.verification not in METHODS:
                wrong.append(f"{at}: {one.id}: verification is '{one.verification}' instead of {', '.join(METHODS)}")
            else:
                found[one.id] = one
    return found


def comment_of(path):
    return _COMMENT["C++" if path.suffix in (".cpp", ".hpp", ".c") else "other"]


def is_head(lines, comment):
    """Whether these lines are only comments, blank lines and a docstring."""
    text = re.sub(r'\A((?:#.*\n|\s)*)"""(?:.|\n)*?"""', r"\1", "\n".join(lines))
    return all(not line.strip() or comment.match(line) for line in text.splitlines())


def test_below(lines, number, comment):
    """Name of the test that begins at lines[number], after comments; None if there is none."""
    while number < len(lines) and comment.match(lines[number]):
        number += 1
    text = "\n".join(lines[number:number + 3])
    for pattern, name in ((_TEST, "{0}.{1}"), (_INSTANTIATED, "{0}/{1}"), (_ADDED, "{0}"), (_CLASS, "{0}")):
        match = pattern.match(text)
        if match:
            return re.sub(r"\$\{\w+\}", "…", name.format(*match.groups()))
    match = _METHOD.match(text)
    if match:
        above = [_CLASS.match(line) for line in lines[:number]]
        return f"{[m[1] for m in above if m][-1]}.{match[1]}"
    return None


def claims_in(root, path, wrong):
    lines = path.read_text(encoding="utf-8").splitlines()
    name, comment = path.relative_to(root).as_posix(), comment_of(path)
    claims = []
    for number, line in enumerate(lines):
        text = comment.match(line)
        claim = text and _VERIFIES.match(text[1])
        if not claim:
            if _BESIDE.search(line):
                wrong.append(f"{name}:{number + 1}: 'Verifies' is not at the beginning of a comment and would not count: "
                             "put it on a line of its own")
            continue
        at, words, end = f"{name}:{number + 1}", claim[1], number + 1
        while "." not in words and end < len(lines) and comment.match(lines[end]):
            words, end = words + " " + comment.match(lines[end])[1], end + 1
        test = "" if is_head(lines[:number], comment) else test_below(lines, end, comment)
        if test is None and comment is _COMMENT["C++"]:
            wrong.append(f"{at}: the comment is neither above a test nor at the file's head")
        for word in re.split(r",|\band\b", words.split(".")[0]):
            if _ID.fullmatch(word.strip()):
                claims.append(Claim(name, number + 1, word.strip(), test or ""))
            else:
                wrong.append(f"{at}: '{word.strip()}' is not an id")
    return claims


def read_claims(root, wrong):
    claims = []
    for path in sorted((root / "tests").rglob("*")):
        apart = (root / "tests/documents/check_requirements.py", root / "tests/documents/test_check_requirements.py")
        if path.suffix in _SOURCES and path.is_file() and path not in apart:
            claims += claims_in(root, path, wrong)
    return claims


def is_audit(claim):
    """Whether the claim is in a script of the audit rather than in a test."""
    path = pathlib.PurePath(claim.path)
    return path.parent.as_posix() == "tests/audit" and path.suffix in (".py", "") and not path.name.startswith("test_")


def read_documents(root):
    """{id: the documents that name it}"""
    naming = collections.defaultdict(list)
    documents = [root / "README.md", root / "fsw/models/README.md", *sorted((root / "docs").glob("*.md"))]
    for path in documents:
        if path.exists():
            for one in sorted(set(_ID.findall(path.read_text(encoding="utf-8")))):
                naming[one].append(path.relative_to(root).as_posix())
    return naming


def inspected(root, requirement):
    """The documents and sources to inspect for this requirement."""
    return [name for name in _DOCUMENT.findall(requirement.text + " " + requirement.rationale) if (root / name).is_file()]


def check(root):
    """(errors, one line each; the list of what verifies each requirement)"""
    wrong = []
    requirements, claims, documents = read_requirements(root, wrong), read_claims(root, wrong), read_documents(root)
    for claim in claims:
        if claim.id not in requirements:
            wrong.append(f"{claim.path}:{claim.line}: there is no requirement {claim.id}")
    for name in sorted(set(documents) - set(requirements)):
        wrong.append(f"{documents[name][0]}: there is no requirement {name}")
    verified = collections.defaultdict(list)
    for one in requirements.values():
        mine = [claim for claim in claims if claim.id == one.id]
        verified[one.id] = list(dict.fromkeys((claim.test or pathlib.PurePath(claim.path).name, claim.path) for claim in mine))
        if one.verification == "T" and all(map(is_audit, mine)):
            wrong.append(f"docs/requirements.csv: no test names {one.id}")
        if one.verification == "A":
            verified[one.id] += [(name, name) for name in documents[one.id]]
            if not documents[one.id] and not any(map(is_audit, mine)):
                wrong.append(f"docs/requirements.csv: neither a script of tests/audit nor a document names {one.id}")
        if one.verification == "I":
            verified[one.id] += [(name, name) for name in inspected(root, one)]
            if not inspected(root, one):
                wrong.append(f"docs/requirements.csv: {one.id} names no file to inspect")
    return wrong, as_document(requirements, verified)


def as_document(requirements, verified):
    counts = collections.Counter(one.verification for one in requirements.values())
    lines = [
        "# Verification",
        "",
        "Generated by `tests/documents/check_requirements.py --write` from [requirements.csv](requirements.csv), which also gives the",
        "rationale, and from the comments in the tests.",
        "",
        f"{len(requirements)} requirements. **T** is a test ({counts['T']}) that ctest runs. **A** is an analysis ({counts['A']}): the audit of the onboard",
        f"processors (`tests/audit/run`) measures it, or a document shows it. **I** is an inspection ({counts['I']}) of the file.",
        "",
        "All tests run in full on the desktop. In the emulators of the onboard processors the tests of the algorithms and of the",
        "application run with fewer random trials, and flip every seventh bit of the triple-redundant state (`tests/support/trials.hpp`).",
    ]
    for group, title in GROUPS.items():
        rows = sorted(one for one in requirements.values() if one.id.split("-")[1] == group)
        if not rows:
            continue
        lines += ["", f"## {title}", "", "| id | requirement | verified by | |", "|---|---|---|---|"]
        for one in rows:
            by = ", ".join(f"[{name}]({link(path)})" for name, path in verified[one.id])
            text = one.text.replace("|", "\\|")
            lines.append(f"| {one.id} | {text} | {by} | {one.verification} |")
    return "\n".join(lines) + "\n"


def link(path):
    """A link to the path from a page in docs/."""
    return path[len("docs/"):] if path.startswith("docs/") else "../" + path


def main(arguments=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--write", type=pathlib.Path, metavar="FILE", help="where to write the list [nowhere]")
    parser.add_argument("--root", type=pathlib.Path, default=ROOT, help="source tree to check [this one]")
    options = parser.parse_args(arguments)
    wrong, document = check(options.root)
    if options.write:
        options.write.parent.mkdir(parents=True, exist_ok=True)
        options.write.write_text(document, encoding="utf-8")
    for line in wrong:
        print(line)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
